// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/multigrid_levels.h"

#include <algorithm>

#include "far_ext/differential/laplacian.h"

namespace limn::eval {

namespace {

using Level = Far::TopologyLevel;

bool IsFixed(Level const& level, Index vertex, FixedVertices fixed) {
    return level.GetVertexEdges(vertex).size() == 0 ||
           (fixed == FixedVertices::Boundary && level.IsVertexBoundary(vertex));
}

/// Fills vertices, numUnknowns and blocks. \return the row of every vertex
std::vector<Index> NumberBreadthFirst(Level const& level, FixedVertices fixed,
                                      MultigridLevel& graph) {
    constexpr Index kFixed = -2, kNew = -1;
    std::vector<Index> rows(static_cast<size_t>(level.GetNumVertices()), kNew);
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (IsFixed(level, vertex, fixed)) rows[vertex] = kFixed;
    }
    graph.vertices.reserve(rows.size());
    for (Index start = 0; start < level.GetNumVertices(); ++start) {
        if (rows[start] != kNew) continue;
        auto const begin = static_cast<Index>(graph.vertices.size());
        bool isSingular = true;
        rows[start] = begin;
        graph.vertices.push_back(start);
        for (size_t at = static_cast<size_t>(begin); at < graph.vertices.size(); ++at) {
            Index const vertex = graph.vertices[at];
            for (Index edge : level.GetVertexEdges(vertex)) {
                Index const other = far_ext::GetOtherEnd(level, edge, vertex);
                if (rows[other] == kFixed) isSingular = false;
                if (rows[other] != kNew) continue;
                rows[other] = static_cast<Index>(graph.vertices.size());
                graph.vertices.push_back(other);
            }
        }
        graph.blocks.push_back({begin, static_cast<Index>(graph.vertices.size()), isSingular});
    }
    graph.numUnknowns = static_cast<Index>(graph.vertices.size());
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (rows[vertex] != kFixed) continue;
        rows[vertex] = static_cast<Index>(graph.vertices.size());
        graph.vertices.push_back(vertex);
    }
    return rows;
}

void ListNeighbours(Level const& level, std::vector<Index> const& rows, MultigridLevel& graph) {
    size_t const numUnknowns = static_cast<size_t>(graph.numUnknowns);
    graph.offsets.assign(numUnknowns + 1, 0);
    for (size_t row = 0; row < numUnknowns; ++row) {
        graph.offsets[row + 1] =
            graph.offsets[row] + level.GetVertexEdges(graph.vertices[row]).size();
    }
    graph.neighbours.resize(static_cast<size_t>(graph.offsets.back()));
    for (size_t row = 0, at = 0; row < numUnknowns; ++row) {
        Index const vertex = graph.vertices[row];
        for (Index edge : level.GetVertexEdges(vertex))
            graph.neighbours[at++] = rows[far_ext::GetOtherEnd(level, edge, vertex)];
    }
}

void LinkToFiner(Level const& level, std::vector<Index> const& rows, MultigridLevel& graph,
                 std::vector<Index> const& fineRows, MultigridLevel& fine) {
    fine.parents.assign(static_cast<size_t>(fine.numUnknowns), {-1, -1});
    graph.children.resize(static_cast<size_t>(graph.numUnknowns));
    for (Index row = 0; row < graph.numUnknowns; ++row) {
        Index const child = fineRows[level.GetVertexChildVertex(graph.vertices[row])];
        graph.children[row] = child;
        fine.parents[child] = {row, row};
    }
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        Index const child = fineRows[level.GetEdgeChildVertex(edge)];
        if (child >= fine.numUnknowns) continue;
        auto const ends = level.GetEdgeVertices(edge);
        fine.parents[child] = {rows[ends[0]], rows[ends[1]]};
    }
    auto const isInFace = [](std::array<Index, 2> const& parents) { return parents[0] < 0; };
    fine.hasFaceVertices = std::any_of(fine.parents.begin(), fine.parents.end(), isInFace);
}

}  // namespace

std::vector<MultigridLevel> BuildMultigridLevels(Far::TopologyRefiner const& refiner,
                                                 FixedVertices fixed, int coarsest) {
    std::vector<MultigridLevel> graphs;
    std::vector<Index> rows, coarseRows;
    for (int k = coarsest; k <= refiner.GetMaxLevel(); ++k) {
        Level const level = refiner.GetLevel(k);
        graphs.emplace_back();
        rows = NumberBreadthFirst(level, fixed, graphs.back());
        ListNeighbours(level, rows, graphs.back());
        if (k > coarsest)
            LinkToFiner(refiner.GetLevel(k - 1), coarseRows, *(graphs.end() - 2), rows,
                        graphs.back());
        coarseRows.swap(rows);
    }
    return graphs;
}

}  // namespace limn::eval
