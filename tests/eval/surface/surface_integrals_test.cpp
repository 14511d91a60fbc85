// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/surface_integrals.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

#include <gtest/gtest.h>

#include "eval/surface/surface_sample.h"
#include "far_ext/topology/refiner.h"
#include "support/instruction_sets.h"
#include "support/meshes.h"
#include "support/scan_meshes.h"

namespace limn {
namespace {

using eval::SurfaceSums;

std::vector<engine::Scene> MakeIntegratedScenes() {
    std::vector<engine::Scene> scenes{test::MakeScan(9), test::MakeTorus(6, 5)};
    for (std::string const& name : test::ListShapes()) {
        scenes.push_back(test::LoadShape(name));
        if (scenes.back().cage.GetNumFaces() > 100) scenes.pop_back();
    }
    return scenes;
}

/// Sums of each face, `blockSize` faces taken together.
std::vector<SurfaceSums> Integrate(engine::Scene const& scene, Index blockSize) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    eval::LimitSurface const surface(*refiner);
    eval::RingCache rings(scene.cage.scheme, scene.cage.options,
                          eval::LimitSurface::kMostRingBytes);
    eval::SurfaceIntegrator integrator(surface, scene.positions, Orientation::Right, rings);
    std::vector<SurfaceSums> sums(static_cast<size_t>(surface.GetNumFaces()));
    for (Index begin = 0; begin < surface.GetNumFaces(); begin += blockSize) {
        Index const end = std::min(begin + blockSize, surface.GetNumFaces());
        integrator.Integrate(
            begin, end,
            std::span(sums).subspan(static_cast<size_t>(begin), static_cast<size_t>(end - begin)));
    }
    return sums;
}

/// The same by one sample after another.
std::vector<SurfaceSums> IntegrateOneByOne(engine::Scene const& scene) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    eval::LimitSurface const surface(*refiner);
    eval::GradedPoints const points(surface);
    eval::FaceTree tree(surface, scene.positions, 3);
    std::vector<SurfaceSums> sums(static_cast<size_t>(surface.GetNumFaces()));
    for (Index face = 0; face < surface.GetNumFaces(); ++face) {
        if (!surface.HasLimit(face)) continue;
        tree.Bind(face);
        points.ForEach(face, [&](eval::SurfacePlace const& place, double weight) {
            auto const x = eval::EvaluateSample(tree, place.domain, place.s, place.t);
            double const area = weight * x.tangentS.cross(x.tangentT).norm();
            SurfaceSums& of = sums[static_cast<size_t>(face)];
            of.volume += area * x.position.dot(x.normal) / 3.0;
            if (area > 0.0 && !x.isDegenerate)
                of.AddCurvature(area, x.curvature.k1, x.curvature.k2);
        });
    }
    return sums;
}

std::vector<uint64_t> GetBits(std::vector<SurfaceSums> const& sums) {
    std::vector<uint64_t> bits;
    for (SurfaceSums const& of : sums) {
        for (double x : {of.area, of.volume, of.bending, of.mean, of.meanSquares, of.gaussian,
                         of.gaussianSquares, of.gaussianMagnitude, of.minMean, of.maxMean,
                         of.minGaussian, of.maxGaussian, static_cast<double>(of.count)})
            bits.push_back(std::bit_cast<uint64_t>(x));
    }
    return bits;
}

TEST(SurfaceIntegrals, AreWhatSamplesOneByOneAddUpTo) {
    for (engine::Scene const& scene : MakeIntegratedScenes()) {
        SCOPED_TRACE(scene.path);
        auto const together = Integrate(scene, scene.cage.GetNumFaces()),
                   single = IntegrateOneByOne(scene);
        for (size_t face = 0; face < single.size(); ++face) {
            SurfaceSums const &a = together[face], &b = single[face];
            ASSERT_EQ(a.count, b.count) << "face " << face;
            ASSERT_NEAR(a.area, b.area, 1e-12 * b.area);
            ASSERT_NEAR(a.volume, b.volume, 1e-10 * (std::abs(b.volume) + b.area));
            ASSERT_NEAR(a.bending, b.bending, 1e-9 * b.bending + 1e-20);
            double const meanScale = std::sqrt(b.meanSquares * b.area);
            ASSERT_NEAR(a.mean, b.mean, 1e-9 * meanScale + 1e-14 * std::sqrt(b.area));
            ASSERT_NEAR(a.gaussian, b.gaussian, 1e-9 * b.bending + 1e-20);
            if (b.count == 0) continue;
            ASSERT_NEAR(a.maxGaussian, b.maxGaussian, 1e-6 * (1.0 + std::abs(b.maxGaussian)));
            ASSERT_NEAR(a.minMean, b.minMean, 1e-6 * (1.0 + std::abs(b.minMean)));
        }
    }
}

TEST(SurfaceIntegrals, OfAFaceDependOnNoOtherFace) {
    for (engine::Scene const& scene : MakeIntegratedScenes()) {
        SCOPED_TRACE(scene.path);
        EXPECT_EQ(GetBits(Integrate(scene, scene.cage.GetNumFaces())),
                  GetBits(Integrate(scene, 11)));
    }
}

TEST(SurfaceIntegrals, HaveTheSameBitsOnEveryInstructionSet) {
    engine::Scene const scan = test::MakeScan(9), torus = test::MakeTorus(6, 5);
    for (engine::Scene const* scene : {&scan, &torus}) {
        std::optional<std::vector<uint64_t>> first;
        test::ForEachInstructionSet([&](eval::InstructionSet) {
            auto const bits = GetBits(Integrate(*scene, scene->cage.GetNumFaces()));
            if (!first) first = bits;
            EXPECT_EQ(bits, *first);
        });
    }
}

}  // namespace
}  // namespace limn
