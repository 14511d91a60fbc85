// SPDX-License-Identifier: Apache-2.0
#include "engine/smooth/cascade_space.h"

#include <algorithm>
#include <cmath>

#include "engine/scene/extent.h"
#include "far_ext/rows/points.h"
#include "far_ext/topology/boundary.h"

namespace limn::engine {

std::vector<double> Times(double factor, std::vector<double> values) {
    for (double& value : values) value *= factor;
    return values;
}

double FindUnit(std::span<double const> positions) {
    double size = 0.0;
    for (size_t i = 3; i < positions.size(); ++i)
        size = std::max(size, std::abs(positions[i] - positions[i % 3]));
    return size > 0.0 && std::isfinite(size) ? std::exp2(std::ilogb(size)) : 1.0;
}

std::vector<double> ToCascade(std::vector<double> const& positions,
                              std::array<double, 3> const& origin, double unit) {
    return Times(1.0 / unit, Subtract(positions, origin));
}

std::vector<int> Inherit(far_ext::CascadeMesh const& mesh, std::vector<int> const& coarse) {
    std::vector<int> fine(mesh.numVertices);
    for (size_t vertex = 0; vertex < fine.size(); ++vertex)
        fine[vertex] = coarse[mesh.parents[mesh.parentOffsets[vertex]]];
    return fine;
}

std::vector<double> Interpolate(far_ext::CascadeMesh const& mesh,
                                std::vector<double> const& coarse) {
    std::vector<double> fine(size_t{3} * mesh.numVertices, 0.0);
    far_ext::Points const parents(coarse);
    far_ext::MutablePoints const points(fine);
    for (Index vertex = 0; vertex < mesh.numVertices; ++vertex) {
        int const begin = mesh.parentOffsets[vertex], end = mesh.parentOffsets[vertex + 1];
        for (int k = begin; k < end; ++k) points[vertex] += parents[mesh.parents[k]];
        points[vertex] /= end - begin;
    }
    return fine;
}

std::optional<eval::KeptFeatures> ScaleFeatures(Model const& model, SmoothOptions const& options,
                                                double unit) {
    if (!options.keptFeatures) return std::nullopt;
    double const meanEdge = far_ext::FindMeanEdgeLength(model.GetLevel(), model.GetPositions());
    return eval::KeptFeatures{*options.keptFeatures * unit, meanEdge / unit};
}

double FindLargestMove(std::span<double const> from, std::span<double const> to) {
    far_ext::Points const before(from), after(to);
    double largest = 0.0;
    for (size_t i = 0; i < before.GetCount(); ++i)
        largest = std::max(largest, (after[i] - before[i]).squaredNorm());
    return std::sqrt(largest);
}

}  // namespace limn::engine
