// SPDX-License-Identifier: Apache-2.0
#include "eval/cascade/sagitta.h"

#include <cmath>

#include <gtest/gtest.h>

#include "support/adaptive_meshes.h"
#include "support/cascade_meshes.h"
#include "support/fit_meshes.h"
#include "support/values.h"

namespace limn {
namespace {

std::vector<double> FindSagittas(engine::Scene const& scene, std::vector<double> const& reach,
                                 std::vector<std::array<Index, 2>> const& creases = {}) {
    return eval::FindSagittas({scene.cage.faceVertices, scene.positions, reach, creases});
}

std::vector<double> FindSagittas(engine::Scene const& scene) {
    return FindSagittas(scene, std::vector<double>(scene.cage.faceVertices.size() / 3, 1e9));
}

// A chord of length e on a sphere of radius r lies e^2 / (8 r) below it; triangles of an icosphere
// are not regular, whence the margin.
TEST(Sagitta, OnASphereItIsThatOfTheLongestChord) {
    auto const sphere = test::MakeIcosphere(3);
    auto const found = FindSagittas(sphere);
    for (size_t face = 0; face < found.size(); ++face) {
        double longest = 0.0;
        for (size_t k = 0; k < 3; ++k) {
            Index const a = sphere.cage.faceVertices[3 * face + k],
                        b = sphere.cage.faceVertices[3 * face + (k + 1) % 3];
            longest = std::max(
                longest, (test::PointAt(sphere.positions, a) - test::PointAt(sphere.positions, b))
                             .squaredNorm());
        }
        EXPECT_NEAR(found[face] / (longest / 8.0), 1.0, 0.1);
    }
}

// Two triangles of height 1, folded by 90 degrees: an arc that turns by as much over a chord of 1.
// Along an edge to a tip the normal turns by 45 degrees, seen from the edge by sqrt(1/2).
TEST(Sagitta, AcrossAFoldItIsThatOfAnArc) {
    auto const fold = test::MakeScene({0, 0, 0, 1, 0, 0, 0.5, 1, 0, 0.5, 0, 1},
                                      {{0, 1, 2}, {1, 0, 3}}, Sdc::SCHEME_LOOP);
    for (double sagitta : FindSagittas(fold))
        EXPECT_NEAR(sagitta, std::tan(test::kPi / 8) / 2, 1e-15);
    for (double sagitta : FindSagittas(fold, std::vector<double>(2, 1e9), {{1, 0}}))
        EXPECT_NEAR(sagitta, std::sqrt(0.5) / 8, 1e-15);
}

TEST(Sagitta, FlatOrUnfilteredMeshesHaveNone) {
    auto flat = test::LoadMesh("gridholetri");
    for (size_t i = 2; i < flat.positions.size(); i += 3) flat.positions[i] = 0.0;
    for (double sagitta : FindSagittas(flat)) EXPECT_EQ(sagitta, 0.0);
    auto const cube = test::MakeTriangleCube();
    for (double sagitta : FindSagittas(cube, std::vector<double>(12, 0.0))) EXPECT_EQ(sagitta, 0.0);
    for (double sagitta : FindSagittas(cube, std::vector<double>(12, 0.01)))
        EXPECT_EQ(sagitta, 0.01);
}

TEST(Sagitta, FoldedAndEmptyTrianglesHaveNumbers) {
    auto const folded = test::MakeScene({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 2, 0, 0},
                                        {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, Sdc::SCHEME_LOOP);
    EXPECT_TRUE(test::AreFinite(FindSagittas(folded)));
}

}  // namespace
}  // namespace limn
