// SPDX-License-Identifier: Apache-2.0
#include "eval/streamlines/even_streamlines.h"

#include <gtest/gtest.h>

#include "far_ext/rows/points.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"
#include "support/streamlines.h"
#include "support/values.h"

namespace limn {
namespace {

using eval::EvenLines;
using eval::FlowSurface;

eval::EvenOptions MakeOptions(FlowSurface const& flow, double separation) {
    return {.line = {.step = separation / 8, .leastSpeed = 1e-6 * flow.FindRmsSpeed()},
            .separation = separation};
}

double FindTotalLength(EvenLines const& even) {
    double sum = 0.0;
    for (auto const& line : even.lines) sum += line.length;
    return sum;
}

/// The least distance between points of different lines.
double FindLeastDistance(EvenLines const& even) {
    double least = 1e300;
    for (size_t i = 0; i < even.lines.size(); ++i) {
        for (size_t j = 0; j < i; ++j) {
            for (auto const& a : even.lines[i].points) {
                for (auto const& b : even.lines[j].points)
                    least = std::min(least, (a.position - b.position).norm());
            }
        }
    }
    return least;
}

// On the unit sphere circles of latitude D apart: pi / D of them, whose length times D is the
// sphere's area; all closed, and no place farther than D from all.
TEST(EvenStreamlines, OfARotationOfASphereAreCirclesOfLatitude) {
    auto const scene = test::MakeIcosphere(3);
    Eigen::Vector3d const axis = far_ext::Points(scene.positions)[0];
    FlowSurface const flow(scene.cage, scene.positions, test::MakeRotationForm(scene, axis));
    for (double const separation : {0.2, 0.1}) {
        auto const even = FillEvenly(flow, MakeOptions(flow, separation));
        EXPECT_NEAR(static_cast<double>(even.lines.size()), M_PI / separation, 1.0);
        for (auto const& line : even.lines) {
            EXPECT_TRUE(line.isClosed);
            for (auto const& point : line.points)
                EXPECT_NEAR(axis.dot(point.position), axis.dot(line.points[0].position), 2e-3);
        }
        ASSERT_TRUE(even.farthest);
        EXPECT_LE(*even.farthest, separation);
        EXPECT_NEAR(FindTotalLength(even) * separation / (4.0 * M_PI), 1.0, 0.1);
    }
}

// On all meshes: other lines are never nearer than half of D, none is shorter than D, and only
// where the field has a singularity is anything left empty.
TEST(EvenStreamlines, KeepApartAndLeaveNothingOut) {
    for (auto const& scene :
         {test::MakeTorus(12, 8), test::MakeQuadSphere(2), test::MakeGridWithHole(9, 7),
          test::MakeCube(), test::MakeIrregularTriangles(9, 8, 3)}) {
        FlowSurface const flow(scene.cage, scene.positions,
                               test::MakeRotationForm(scene, {0.3, 0.2, 1.0}));
        double const separation = 0.05 * test::BoxDiagonal(scene.positions);
        auto const even = FillEvenly(flow, MakeOptions(flow, separation));
        EXPECT_GT(even.lines.size(), 5u);
        EXPECT_GE(FindLeastDistance(even), 0.5 * separation);
        for (auto const& line : even.lines) EXPECT_GE(line.length, separation);
        ASSERT_TRUE(even.farthest);
        EXPECT_LE(*even.farthest, 1.2 * separation);
    }
}

TEST(EvenStreamlines, AreTheSameEveryTime) {
    auto const scene = test::MakeTorus(12, 8);
    FlowSurface const flow(scene.cage, scene.positions,
                           test::MakeRotationForm(scene, {0.3, 0.2, 1.0}));
    auto const options = MakeOptions(flow, 0.3);
    auto const a = FillEvenly(flow, options), b = FillEvenly(flow, options);
    ASSERT_EQ(a.lines.size(), b.lines.size());
    for (size_t i = 0; i < a.lines.size(); ++i) {
        ASSERT_EQ(a.lines[i].points.size(), b.lines[i].points.size());
        EXPECT_EQ(a.lines[i].points.back().position, b.lines[i].points.back().position);
    }
}

TEST(EvenStreamlines, ThroughSeedsStopNearThoseBefore) {
    auto const scene = test::MakeTorus(12, 8);
    FlowSurface const flow(scene.cage, scene.positions,
                           test::MakeRotationForm(scene, {0.3, 0.2, 1.0}));
    std::vector<eval::SurfacePlace> seeds;
    for (Index face = 0; face < flow.GetLevel().GetNumFaces(); face += 3)
        seeds.push_back({face, 0, 0.5, 0.5});
    double const separation = 0.3;
    auto const even = TraceApart(flow, seeds, MakeOptions(flow, separation));
    EXPECT_GT(even.lines.size(), 3u);
    EXPECT_LE(even.lines.size(), seeds.size());
    EXPECT_GE(FindLeastDistance(even), 0.5 * separation);
}

TEST(EvenStreamlines, OfNoFieldAreNone) {
    auto const scene = test::MakeCube();
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    FlowSurface const flow(scene.cage, scene.positions,
                           std::vector<double>(refiner->GetLevel(0).GetNumEdges(), 0.0));
    auto const even = FillEvenly(flow, MakeOptions(flow, 0.2));
    EXPECT_TRUE(even.lines.empty());
    EXPECT_FALSE(even.farthest);
}

TEST(EvenStreamlines, TooManyAreRefused) {
    auto const scene = test::MakeCube();
    FlowSurface const flow(scene.cage, scene.positions,
                           test::MakeRotationForm(scene, {0.0, 0.0, 1.0}));
    EXPECT_EQ(test::CodeOf([&] { FillEvenly(flow, MakeOptions(flow, 1e-6)); }),
              ErrorCode::TooLarge);
}

}  // namespace
}  // namespace limn
