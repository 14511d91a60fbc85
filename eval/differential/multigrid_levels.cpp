// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/multigrid_levels.h"

#include <algorithm>
#include <span>
#include <utility>

#include "far_ext/rows/breadth_first.h"
#include "far_ext/topology/boundary.h"

namespace limn::eval {

namespace {

using Level = Far::TopologyLevel;

bool IsFixed(Level const& level, Index vertex, FixedVertices fixed) {
    return level.GetVertexEdges(vertex).size() == 0 ||
           (fixed == FixedVertices::Boundary && level.IsVertexBoundary(vertex));
}

far_ext::BreadthFirstOrder OrderAlongEdges(Level const& level, FixedVertices fixed) {
    auto const visitNeighbours = [&](Index vertex, auto const& visit) {
        for (Index edge : level.GetVertexEdges(vertex))
            visit(far_ext::GetOtherEnd(level, edge, vertex));
    };
    return far_ext::OrderBreadthFirst(level.GetNumVertices(), visitNeighbours,
                                      [&](Index vertex) { return IsFixed(level, vertex, fixed); });
}

void ListNeighbours(Level const& level, std::span<Index const> rows, MultigridLevel& graph) {
    size_t const numUnknowns = graph.numUnknowns;
    graph.offsets.assign(numUnknowns + 1, 0);
    for (size_t row = 0; row < numUnknowns; ++row) {
        graph.offsets[row + 1] =
            graph.offsets[row] + level.GetVertexEdges(graph.vertices[row]).size();
    }
    graph.neighbours.resize(graph.offsets.back());
    for (size_t row = 0, at = 0; row < numUnknowns; ++row) {
        Index const vertex = graph.vertices[row];
        for (Index edge : level.GetVertexEdges(vertex))
            graph.neighbours[at++] = rows[far_ext::GetOtherEnd(level, edge, vertex)];
    }
}

/// \param componentOffsets  where each component's unknowns begin, and the end of the last
void ListBlocks(std::span<Index const> componentOffsets, MultigridLevel& graph) {
    auto const isUnknown = [&](Index row) { return row < graph.numUnknowns; };
    for (size_t i = 0; i + 1 < componentOffsets.size(); ++i) {
        Index const begin = componentOffsets[i], end = componentOffsets[i + 1];
        bool const isSingular =
            std::all_of(graph.neighbours.begin() + graph.offsets[begin],
                        graph.neighbours.begin() + graph.offsets[end], isUnknown);
        graph.blocks.push_back({begin, end, isSingular});
    }
}

void LinkToFiner(Level const& level, std::span<Index const> rows, MultigridLevel& graph,
                 std::span<Index const> fineRows, MultigridLevel& fine) {
    fine.parents.assign(fine.numUnknowns, {-1, -1});
    graph.children.resize(graph.numUnknowns);
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
    far_ext::LargeArray<Index> coarseRows;
    for (int k = coarsest; k <= refiner.GetMaxLevel(); ++k) {
        Level const& level = refiner.GetLevel(k);
        auto order = OrderAlongEdges(level, fixed);
        auto rows = far_ext::InvertOrder(order.rows);
        MultigridLevel& graph = graphs.emplace_back();
        graph.numUnknowns = order.GetNumFree();
        graph.vertices = std::move(order.rows);
        ListNeighbours(level, rows, graph);
        ListBlocks(order.componentOffsets, graph);
        if (k > coarsest)
            LinkToFiner(refiner.GetLevel(k - 1), coarseRows, *(graphs.end() - 2), rows, graph);
        coarseRows = std::move(rows);
    }
    return graphs;
}

}  // namespace limn::eval
