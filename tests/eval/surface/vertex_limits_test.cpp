// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/vertex_limits.h"

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/refined.h"

namespace limn {
namespace {

// The limit of a cube's corner: own weight 9/24, three edge ends 4/24 each, three face opposites
// 1/24 each; of coordinates +-1 that leaves (9 + 4 - 1) / 24.
TEST(VertexLimits, ACubesCornersMoveInByHalf) {
    auto const cube = test::MakeCube();
    auto const refiner = test::MakeRefiner(cube, 0);
    eval::LimitSurface const surface(*refiner);
    double const corner = std::abs(cube.positions[0]);
    auto const limits = eval::EvaluateVertexLimits(surface, cube.positions, 3);
    EXPECT_EQ(limits.hasLimit, std::vector<char>(8, 1));
    for (size_t i = 0; i < cube.positions.size(); ++i)
        EXPECT_NEAR(limits.values[i], 0.5 * cube.positions[i], 1e-12 * corner);
}

TEST(VertexLimits, ValuesThatAreTooShortAreRefused) {
    auto const refiner = test::MakeRefiner(test::MakeCube(), 0);
    eval::LimitSurface const surface(*refiner);
    std::vector<double> const six(6);
    EXPECT_EQ(test::RefusalOf([&] { eval::EvaluateVertexLimits(surface, six, 3); }),
              "control points: 6 values are too few for 8 vertices of 3");
}

}  // namespace
}  // namespace limn
