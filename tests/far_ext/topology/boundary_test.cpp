// SPDX-License-Identifier: Apache-2.0
#include "far_ext/topology/boundary.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/refined.h"

namespace limn {
namespace {

using Loops = std::vector<std::vector<Index>>;

// A strip of two quads: vertices 0 1 2 below, 3 4 5 above.
engine::Scene MakeStrip() {
    return test::MakeScene({0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 3, 0, 1, 3, 0, 2, 3, 0},
                           {{0, 1, 4, 3}, {1, 2, 5, 4}});
}

TEST(Boundary, TheOtherEndOfTheOtherEndIsTheVertexItself) {
    auto const refiner = test::MakeRefiner(test::MakeCube(), 0);
    auto const level = refiner->GetLevel(0);
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        Index const vertex = level.GetEdgeVertices(edge)[0],
                    other = far_ext::GetOtherEnd(level, edge, vertex);
        EXPECT_NE(other, vertex);
        EXPECT_EQ(far_ext::GetOtherEnd(level, edge, other), vertex);
    }
}

// Four edges of length 1 along the strip, three of length 3 across it.
TEST(Boundary, TheMeanEdgeCountsEveryEdgeOnce) {
    auto const scene = MakeStrip();
    auto const refiner = test::MakeRefiner(scene, 0);
    EXPECT_EQ(far_ext::FindMeanEdgeLength(refiner->GetLevel(0), scene.positions), 13.0 / 7.0);
}

TEST(Boundary, AVertexInsideHasNoNeighboursAlongIt) {
    auto const refiner = test::MakeRefiner(test::MakeCube(), 0);
    EXPECT_EQ(far_ext::GetBoundaryNeighbours(refiner->GetLevel(0), 3),
              (std::array<Index, 2>{-1, -1}));
}

TEST(Boundary, NeighboursAlongItSkipEdgesInside) {
    auto const refiner = test::MakeRefiner(MakeStrip(), 0);
    auto neighbours = far_ext::GetBoundaryNeighbours(refiner->GetLevel(0), 1);
    std::sort(neighbours.begin(), neighbours.end());
    EXPECT_EQ(neighbours, (std::array<Index, 2>{0, 2}));
}

TEST(Boundary, AClosedMeshHasNoLoops) {
    auto const refiner = test::MakeRefiner(test::MakeTorus(7, 5), 1);
    EXPECT_EQ(far_ext::FindBoundaryLoops(refiner->GetLevel(1)), Loops{});
}

TEST(Boundary, EachLoopIsFoundOnce) {
    auto const refiner =
        test::MakeRefiner(test::LoadDifferential("gridholetri", Sdc::SCHEME_LOOP), 2);
    auto const level = refiner->GetLevel(2);
    auto const loops = far_ext::FindBoundaryLoops(level);
    ASSERT_EQ(loops.size(), 2u);
    std::vector<int> timesFound(static_cast<size_t>(level.GetNumVertices()), 0);
    for (auto const& loop : loops) {
        EXPECT_EQ(loop.front(), *std::min_element(loop.begin(), loop.end()));
        for (Index vertex : loop) ++timesFound[vertex];
    }
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex)
        EXPECT_EQ(timesFound[vertex], level.IsVertexBoundary(vertex)) << vertex;
}

TEST(Boundary, ALoopGoesFromNeighbourToNeighbour) {
    auto const refiner = test::MakeRefiner(MakeStrip(), 1);
    auto const level = refiner->GetLevel(1);
    auto const loops = far_ext::FindBoundaryLoops(level);
    ASSERT_EQ(loops.size(), 1u);
    for (size_t i = 0; i < loops[0].size(); ++i) {
        auto const [a, b] = far_ext::GetBoundaryNeighbours(level, loops[0][i]);
        Index const next = loops[0][(i + 1) % loops[0].size()];
        EXPECT_TRUE(next == a || next == b) << i;
    }
}

// Two triangles that touch in a vertex.
TEST(Boundary, CurvesThatMeetAreRefused) {
    auto const scene = test::MakeScene({0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0},
                                       {{0, 1, 2}, {0, 3, 4}}, Sdc::SCHEME_LOOP);
    auto const refiner = test::MakeRefiner(scene, 0);
    auto const refusal = test::RefusalOf([&] { far_ext::CheckBoundary(refiner->GetLevel(0)); });
    EXPECT_NE(refusal.find("vertex 0 has 4 boundary edges"), std::string::npos) << refusal;
}

}  // namespace
}  // namespace limn
