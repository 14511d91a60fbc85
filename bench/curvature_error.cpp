// SPDX-License-Identifier: Apache-2.0
//
// How wrong is curvature next to an extraordinary vertex? Prints the README's table: the worst
// texel of a 256 x 256 map of mean curvature over one face of a smooth Catmull-Clark fan,
// OpenSubdiv's defaults and limn against OpenSubdiv isolated as deep as it goes, in double.

#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>

#include "eval/surface/surface_sampler.h"
#include "far_ext/topology/refiner.h"
#include "support/meshes.h"

namespace {

using namespace limn;
namespace Bfr = OpenSubdiv::Bfr;

constexpr int kSize = 256;

std::vector<double> MapByBfr(Far::TopologyRefiner const& refiner,
                             std::vector<double> const& positions, int level) {
    Bfr::SurfaceFactory::Options options;
    if (level > 0) {
        options.SetApproxLevelSmooth(level);
        options.SetApproxLevelSharp(level);
    }
    Bfr::RefinerSurfaceFactory<> const factory(refiner, options);
    std::unique_ptr<Bfr::Surface<double>> const surface(factory.CreateVertexSurface<double>(0));
    std::vector<double> points(static_cast<size_t>(surface->GetNumPatchPoints()) * 3);
    surface->PreparePatchPoints(positions.data(), {3}, points.data(), {3});
    std::vector<double> map;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            double const st[2] = {(x + 0.5) / kSize, (y + 0.5) / kSize};
            Eigen::Vector3d p, s, t, ss, sT, tt;
            surface->Evaluate(st, points.data(), {3}, p.data(), s.data(), t.data(), ss.data(),
                              sT.data(), tt.data());
            map.push_back(eval::ComputeCurvature(s, t, ss, sT, tt).mean);
        }
    }
    return map;
}

std::vector<double> MapByLimn(Far::TopologyRefiner const& refiner,
                              std::vector<double> const& positions) {
    eval::LimitSurface const surface(refiner);
    eval::FaceTree tree(surface, positions, 3);
    eval::SurfaceSampler sampler(tree, eval::Quantity::Curvature, Orientation::Right);
    std::vector<double> s, t, map(kSize * kSize);
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            s.push_back((x + 0.5) / kSize);
            t.push_back((y + 0.5) / kSize);
        }
    }
    sampler.Bind(0);
    sampler.Evaluate(0, s, t,
                     [&](std::span<int const> samples, float const* planes, size_t stride) {
                         for (size_t i = 0; i < samples.size(); ++i) {
                             map[static_cast<size_t>(samples[i])] =
                                 static_cast<double>(planes[eval::kMean * stride + i]);
                         }
                     });
    return map;
}

double WorstRelative(std::vector<double> const& map, std::vector<double> const& reference) {
    double worst = 0.0;
    for (size_t i = 0; i < map.size(); ++i) {
        worst = std::max(worst, std::abs(map[i] - reference[i]) / std::abs(reference[i]));
    }
    return worst;
}

}  // namespace

int main() {
    fmt::print("| valence | OpenSubdiv's defaults | limn |\n| --- | --- | --- |\n");
    bool isRight = true;
    for (int valence : {3, 5, 6, 7, 8, 12}) {
        engine::Scene const fan = test::MakeFan(valence, Sdc::SCHEME_CATMARK, -0.1, 0.0);
        auto const refiner = far_ext::CreateRefiner(fan.cage);
        auto const reference = MapByBfr(*refiner, fan.positions, 10);
        double const theirs = WorstRelative(MapByBfr(*refiner, fan.positions, 0), reference);
        double const ours = WorstRelative(MapByLimn(*refiner, fan.positions), reference);
        fmt::print("| {} | {:.0f} % | {:.5f} % |\n", valence, 100 * theirs, 100 * ours);
        isRight &= ours < 1e-4;
    }
    return isRight ? 0 : 1;
}
