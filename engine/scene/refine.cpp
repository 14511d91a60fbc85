// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/refine.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "engine/scene/job.h"
#include "eval/differential/subdivide_values.h"
#include "eval/surface/vertex_limits.h"
#include "far_ext/error.h"
#include "far_ext/topology/refined_cage.h"
#include "far_ext/topology/refiner.h"

namespace limn::engine {

namespace {

using Level = Far::TopologyLevel;

/// Refines values of length N through all levels: of vertices, or of a face-varying channel.
template <size_t N>
std::vector<double> RefineToLast(Far::TopologyRefiner const& refiner, std::span<double const> base,
                                 int fvarChannel = -1) {
    std::vector<double> values(base.begin(), base.end());
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
        CheckInterrupted();
        values = eval::RefineValues<N>(refiner, level, values, fvarChannel);
    }
    return values;
}

Primvar RefinePrimvar(Far::TopologyRefiner const& refiner, Primvar const& primvar) {
    Primvar fine{primvar.name, primvar.numChannels, {}};
    size_t const n = static_cast<size_t>(primvar.numChannels);
    for (size_t c = 0; c < n; ++c) {
        std::vector<double> channel;
        for (size_t i = c; i < primvar.values.size(); i += n)
            channel.push_back(static_cast<double>(primvar.values[i]));
        auto const refined = RefineToLast<1>(refiner, channel);
        fine.values.resize(refined.size() * n);
        for (size_t i = 0; i < refined.size(); ++i)
            fine.values[i * n + c] = static_cast<float>(refined[i]);
    }
    return fine;
}

/// Moves refined vertices to the limit. Vertices without a face that has one stay.
void MoveToLimit(Scene& fine) {
    auto const refiner = far_ext::CreateRefiner(fine.cage);
    eval::LimitSurface const surface(*refiner);
    fine.positions = eval::EvaluateVertexLimits(surface, fine.positions, 3,
                                                eval::FaceTree::kLimitDepth, CheckInterrupted)
                         .values;
}

}  // namespace

std::unique_ptr<Far::TopologyRefiner> MakeUniformRefiner(Scene const& scene, int levels) {
    if (levels < 0 || levels > 10) {
        throw Error(ErrorCode::BadOption, fmt::format("`levels`: {} is not from 0 to 10", levels));
    }
    double const corners =
        static_cast<double>(scene.cage.faceVertices.size()) * std::pow(4.0, levels);
    if (corners > 2e9) {
        throw Error(ErrorCode::TooLarge,
                    fmt::format("{}: {} levels would make {:.1e} face corners; at most 2e9 can be "
                                "indexed",
                                scene.path, levels, corners));
    }
    auto refiner = far_ext::CreateRefiner(scene.cage);
    Far::TopologyRefiner::UniformOptions uniform(levels);
    uniform.fullTopologyInLastLevel = true;
    refiner->RefineUniform(uniform);
    return refiner;
}

void InheritGroups(Scene const& scene, std::vector<Index> const& baseFaces, Scene& fine) {
    for (size_t kind = 0; kind < 3; ++kind) {
        fine.groups[kind].names = scene.groups[kind].names;
        if (scene.groups[kind].faceGroup.empty()) continue;
        for (Index face : baseFaces)
            fine.groups[kind].faceGroup.push_back(scene.groups[kind].faceGroup[face]);
    }
}

Scene RefineAllButPositions(Scene const& scene, Far::TopologyRefiner const& refiner) {
    Scene fine;
    fine.path = scene.path;
    fine.name = scene.name;
    fine.cage = far_ext::MakeRefinedCage(refiner, scene.cage);
    if (scene.HasUVs()) fine.uvs = RefineToLast<2>(refiner, scene.uvs, 0);
    for (Primvar const& primvar : scene.primvars)
        fine.primvars.push_back(RefinePrimvar(refiner, primvar));
    InheritGroups(scene, far_ext::FindBaseFaces(refiner, refiner.GetMaxLevel()), fine);
    return fine;
}

Scene RefineUniformly(Scene const& scene, int levels, bool toLimit, far_ext::SubdivisionRule rule) {
    auto const refiner = MakeUniformRefiner(scene, levels);
    Scene fine = RefineAllButPositions(scene, *refiner);
    fine.positions = scene.positions;
    for (int level = 1; level <= levels; ++level) {
        CheckInterrupted();
        fine.positions = eval::SubdivideValues<3>(*refiner, level, rule, fine.positions);
    }
    if (toLimit && rule == far_ext::SubdivisionRule::Scheme) MoveToLimit(fine);
    return fine;
}

}  // namespace limn::engine
