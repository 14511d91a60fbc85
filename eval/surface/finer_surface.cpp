// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/finer_surface.h"

#include "eval/surface/surface_sample.h"
#include "far_ext/rows/points.h"
#include "far_ext/topology/refined_cage.h"
#include "far_ext/topology/refiner.h"

namespace limn::eval {

namespace {

/// How often a cage was refined to have so many faces, or 0.
int FindLevels(far_ext::ControlMesh const& cage, Index numFaces) {
    double count = cage.scheme == Sdc::SCHEME_LOOP ? 4.0 * cage.GetNumFaces()
                                                   : static_cast<double>(cage.faceVertices.size());
    for (int level = 1; level <= 10; ++level, count *= 4.0) {
        if (count == static_cast<double>(numFaces)) return level;
    }
    return 0;
}

}  // namespace

std::optional<FinerSurface> FinerSurface::Build(LimitSurface const& base,
                                                far_ext::ControlMesh const& cage,
                                                far_ext::ControlMesh const& finer,
                                                std::span<double const> positions) {
    far_ext::CheckPoints(positions, finer.numVertices);
    int const levels = cage.scheme == finer.scheme ? FindLevels(cage, finer.GetNumFaces()) : 0;
    if (levels == 0) return {};
    auto const refined = far_ext::CreateRefiner(cage);
    Far::TopologyRefiner::UniformOptions options(levels);
    options.fullTopologyInLastLevel = true;
    refined->RefineUniform(options);
    auto const level = refined->GetLevel(levels);
    size_t const n = cage.scheme == Sdc::SCHEME_LOOP ? 3 : 4;
    if (level.GetNumVertices() != finer.numVertices ||
        finer.faceVertices.size() != n * finer.faceSizes.size())
        return {};
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        auto const vertices = level.GetFaceVertices(face);
        for (size_t k = 0; k < n; ++k) {
            if (finer.faceSizes[face] != static_cast<int>(n) ||
                finer.faceVertices[face * n + k] != vertices[static_cast<int>(k)])
                return {};
        }
    }
    FinerSurface surface(base, levels);
    surface._positions.assign(positions.begin(), positions.end());
    surface._refiner = far_ext::CreateRefiner(finer);
    surface._limit = std::make_unique<LimitSurface>(*surface._refiner);
    auto const baseFaces = far_ext::FindBaseFaces(*refined, levels);
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        if (base.HasLimit(baseFaces[face]) && !surface._limit->HasLimit(face)) return {};
    }
    return surface;
}

FinerSurface::Sampler::Sampler(FinerSurface const& surface)
    : _surface(surface), _tree(*surface._limit, surface._positions, 3) {}

void FinerSurface::Sampler::Evaluate(Index face, int domain, std::span<double const> s,
                                     std::span<double const> t, std::span<Eigen::Vector3d> points) {
    CheckRoom(points.size(), s.size());
    _surface._faces.FindSorted(face, domain, s, t, _places);
    Index bound = -1;
    for (auto const& [at, index] : _places) {
        if (at.face != bound) _tree.Bind(at.face);
        bound = at.face;
        PatchPoint const piece = _tree.LocateChecked(at.domain, at.s, at.t, FaceTree::kLimitDepth);
        points[index] = EvaluateDerivatives(_tree, piece).position;
    }
}

}  // namespace limn::eval
