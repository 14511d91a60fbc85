// SPDX-License-Identifier: Apache-2.0
#include "far_ext/rows/breadth_first.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace limn {
namespace {

using far_ext::BreadthFirstOrder;
using Graph = std::vector<std::vector<Index>>;  // per row: its neighbours

/// A grid of n x n rows numbered at random, joined to those left, right, below and above.
Graph MakeShuffledGrid(Index n) {
    std::vector<Index> numbers(static_cast<size_t>(n * n));
    std::iota(numbers.begin(), numbers.end(), 0);
    std::shuffle(numbers.begin(), numbers.end(), std::mt19937(3));
    Graph graph(numbers.size());
    auto const join = [&](Index a, Index b) {
        graph[numbers[a]].push_back(numbers[b]);
        graph[numbers[b]].push_back(numbers[a]);
    };
    for (Index i = 0; i < n * n; ++i) {
        if (i % n + 1 < n) join(i, i + 1);
        if (i + n < n * n) join(i, i + n);
    }
    return graph;
}

BreadthFirstOrder Order(Graph const& graph, std::vector<Index> const& fixed = {}) {
    return far_ext::OrderBreadthFirst(
        static_cast<Index>(graph.size()),
        [&](Index row, auto const& visit) {
            for (Index neighbour : graph[row]) visit(neighbour);
        },
        [&](Index row) { return std::find(fixed.begin(), fixed.end(), row) != fixed.end(); });
}

TEST(OrderBreadthFirst, EveryRowComesOnce) {
    auto rows = Order(MakeShuffledGrid(17), {3, 40, 41}).rows;
    std::sort(rows.begin(), rows.end());
    std::vector<Index> all(17 * 17);
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(rows, all);
}

// All rows k edges from the seed come before those k + 1 edges from it. Of an n x n grid each
// column has at most two of the former, so that there are at most 2 n.
TEST(OrderBreadthFirst, NeighboursOnAGridLieNearEachOther) {
    Index const n = 40;
    Graph const graph = MakeShuffledGrid(n);
    auto const number = far_ext::InvertOrder(Order(graph).rows);
    Index farthest = 0;
    for (size_t row = 0; row < graph.size(); ++row) {
        for (Index neighbour : graph[row])
            farthest = std::max(farthest, std::abs(number[row] - number[neighbour]));
    }
    EXPECT_LT(farthest, 4 * n);
}

TEST(OrderBreadthFirst, NeighboursFollowInTheOrderTheyAreVisitedIn) {
    Graph const graph{{3, 1}, {0, 2}, {1}, {0, 4}, {3}};
    EXPECT_EQ(Order(graph).rows, (std::vector<Index>{0, 3, 1, 4, 2}));
}

TEST(OrderBreadthFirst, ComponentsFollowEachOtherByTheirLowestRow) {
    Graph const graph{{4}, {3, 2}, {1}, {1}, {0}, {}};
    auto const order = Order(graph);
    EXPECT_EQ(order.rows, (std::vector<Index>{0, 4, 1, 3, 2, 5}));
    EXPECT_EQ(order.componentOffsets, (std::vector<Index>{0, 2, 5, 6}));
}

// A path of five rows, cut by its fixed middle.
TEST(OrderBreadthFirst, FixedRowsComeLastAndAreNotPassedThrough) {
    Graph const graph{{1}, {0, 2}, {1, 3}, {2, 4}, {3}};
    auto const order = Order(graph, {2});
    EXPECT_EQ(order.rows, (std::vector<Index>{0, 1, 3, 4, 2}));
    EXPECT_EQ(order.componentOffsets, (std::vector<Index>{0, 2, 4}));
    EXPECT_EQ(order.GetNumFree(), 4);
}

TEST(OrderBreadthFirst, FixedRowsKeepTheirOrder) {
    auto const order = Order(Graph(6), {4, 0, 5});
    EXPECT_EQ(order.rows, (std::vector<Index>{1, 2, 3, 0, 4, 5}));
}

TEST(OrderBreadthFirst, NoRowsHaveNoComponents) {
    auto const order = Order({});
    EXPECT_TRUE(order.rows.empty());
    EXPECT_EQ(order.GetNumFree(), 0);
}

TEST(InvertOrder, GivesEachRowItsPlace) {
    std::vector<Index> const rows{2, 0, 3, 1};
    auto const inverse = far_ext::InvertOrder(rows);
    for (size_t place = 0; place < rows.size(); ++place)
        EXPECT_EQ(inverse[rows[place]], static_cast<Index>(place));
}

}  // namespace
}  // namespace limn
