// SPDX-License-Identifier: Apache-2.0
#include "far_ext/topology/boundary.h"

#include <algorithm>

#include <fmt/format.h>

#include "far_ext/error.h"
#include "far_ext/rows/points.h"

namespace limn::far_ext {

using Level = Far::TopologyLevel;

double FindMeanEdgeLength(Level const& level, std::span<double const> positions) {
    Points const points(positions);
    double sum = 0.0;
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const ends = level.GetEdgeVertices(edge);
        sum += (points[ends[1]] - points[ends[0]]).norm();
    }
    return sum / std::max(1, level.GetNumEdges());
}

std::array<Index, 2> GetBoundaryNeighbours(Level const& level, Index vertex) {
    std::array<Index, 2> neighbours{-1, -1};
    size_t count = 0;
    for (Index edge : level.GetVertexEdges(vertex)) {
        if (level.IsEdgeBoundary(edge) && count < 2)
            neighbours[count++] = GetOtherEnd(level, edge, vertex);
    }
    return neighbours;
}

void CheckBoundary(Level const& level) {
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (!level.IsVertexBoundary(vertex)) continue;
        int count = 0;
        for (Index edge : level.GetVertexEdges(vertex)) count += level.IsEdgeBoundary(edge);
        if (count == 0 || count == 2) continue;
        throw Error(ErrorCode::BadMesh,
                    fmt::format("vertex {} has {} boundary edges; at most one boundary can pass a "
                                "vertex, so split it",
                                vertex, count));
    }
}

std::vector<std::vector<Index>> FindBoundaryLoops(Level const& level) {
    std::vector<char> isDone(level.GetNumVertices(), 0);
    std::vector<std::vector<Index>> loops;
    for (Index start = 0; start < level.GetNumVertices(); ++start) {
        if (isDone[start] || GetBoundaryNeighbours(level, start)[0] < 0) continue;
        std::vector<Index> loop;
        for (Index at = start; !isDone[at];) {
            isDone[at] = 1;
            loop.push_back(at);
            auto const [a, b] = GetBoundaryNeighbours(level, at);
            at = isDone[a] ? b : a;
        }
        loops.push_back(std::move(loop));
    }
    return loops;
}

}  // namespace limn::far_ext
