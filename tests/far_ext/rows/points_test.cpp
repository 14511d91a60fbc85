// SPDX-License-Identifier: Apache-2.0
#include "far_ext/rows/points.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/refined.h"

namespace limn {
namespace {

using far_ext::MutablePoints;
using far_ext::Points;

TEST(Points, APointIsTheThreeNumbersOfItsVertex) {
    std::vector<double> const positions{0, 1, 2, 3, 4, 5};
    Points const points(positions);
    EXPECT_EQ(points.GetCount(), 2u);
    EXPECT_EQ(points[1], Eigen::Vector3d(3, 4, 5));
}

TEST(Points, AChangedPointIsChangedInTheArray) {
    std::vector<double> positions{0, 1, 2, 3, 4, 5};
    MutablePoints const points(positions);
    points[0] = Eigen::Vector3d(6, 7, 8);
    points[1] += points[0];
    EXPECT_EQ(positions, (std::vector<double>{6, 7, 8, 9, 11, 13}));
}

// Whether numbers are added by a loop or by Eigen shows in no bit of a mesh.
TEST(Points, SumsOverCoordinatesAreThoseOfALoop) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
    std::vector<double> positions(6);
    Points const points(positions);
    for (int repeat = 0; repeat < 1000; ++repeat) {
        for (double& x : positions) x = coordinate(random);
        double dot = 0.0, square = 0.0;
        for (size_t c = 0; c < 3; ++c) {
            double const d = positions[3 + c] - positions[c];
            dot += positions[c] * positions[3 + c];
            square += d * d;
        }
        ASSERT_EQ(points[0].dot(points[1]), dot);
        ASSERT_EQ((points[1] - points[0]).squaredNorm(), square);
        ASSERT_EQ((points[1] - points[0]).norm(), std::sqrt(square));
    }
}

TEST(Points, AnArrayOfTheLeastLengthIsEnough) {
    std::vector<double> const positions(24);
    EXPECT_NO_THROW(far_ext::CheckPoints(positions, 8));
}

TEST(Points, AnArrayThatIsTooShortIsRefusedWithItsBound) {
    std::vector<double> const positions(6);
    EXPECT_EQ(test::RefusalOf([&] { far_ext::CheckPoints(positions, 8); }),
              "positions: 6 values are too few for 8 vertices of 3");
    EXPECT_EQ(test::CodeOf([&] { far_ext::CheckPoints(positions, 8); }), ErrorCode::BadOption);
}

}  // namespace
}  // namespace limn
