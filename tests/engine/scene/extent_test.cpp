// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/extent.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/values.h"

namespace limn {
namespace {

using engine::Extent;
using engine::FindExtent;

/// Points in a box of size 2, moved.
std::vector<double> MakePoints(double x, double y, double z) {
    std::vector<double> points = test::MakeNoise(300, 7);
    double const shift[] = {x, y, z};
    for (size_t i = 0; i < points.size(); ++i) points[i] += shift[i % 3];
    return points;
}

TEST(Extent, IsTheBoxRoundThePoints) {
    std::vector<double> const points{1, -5, 2, 3, -7, 2, 2, -6, 8};
    Extent const extent = FindExtent(points);
    EXPECT_EQ(extent.low, (std::array<double, 3>{1, -7, 2}));
    EXPECT_EQ(extent.high, (std::array<double, 3>{3, -5, 8}));
    EXPECT_EQ(extent.GetFarthest(), 8.0);
    EXPECT_DOUBLE_EQ(extent.GetDiagonal(), std::sqrt(4.0 + 4.0 + 36.0));
    EXPECT_EQ(FindExtent({}).GetDiagonal(), 0.0);
}

// The middle of the box is (2, -5, 0), and it reaches 4 from there at most.
TEST(Extent, GrowthIsHowMuchFartherThanTheBoxThePointsReach) {
    Extent const box{{-2, -8, 0}, {6, -2, 0}};
    EXPECT_EQ(engine::FindGrowth(box, box), 1.0);
    EXPECT_EQ(engine::FindGrowth(box, {{0, -5, 0}, {2, -5, 0}}), 0.5);
    EXPECT_EQ(engine::FindGrowth(box, {{-2, -8, 0}, {6, -2, 40}}), 10.0);
    EXPECT_EQ(engine::FindGrowth(box, {{-2, -25, 0}, {6, -2, 1}}), 5.0);
    EXPECT_EQ(engine::FindGrowth(FindExtent({}), box), 1.0);
}

TEST(Extent, AStepLeadsToTheNextFloat) {
    float const infinity = std::numeric_limits<float>::infinity();
    for (float x : {1e-45f, 1e-40f, 0.1f, 1.0f, 1.5f, 2.0f, 1003.0f, 5411932.5f, 3e38f})
        EXPECT_EQ(engine::GetFloatStep(x), std::nextafter(x, infinity) - double{x}) << x;
    EXPECT_EQ(engine::GetHalfStep(1.0), 0x1p-10);
    EXPECT_EQ(engine::GetHalfStep(1003.0), 0.5);
    EXPECT_EQ(engine::GetHalfStep(0.0), 0x1p-24);
}

TEST(Extent, FloatsKeepWhatTheyAreSaidTo) {
    int numEnough = 0;
    for (double distance : {0.0, 1.0, 10.0, 30.0, 100.0, 1e4, 5e6, 1e-44, 1e30}) {
        for (double scale : {1.0, 1e-30}) {
            auto points = MakePoints(distance, -distance, 0.0);
            for (double& x : points) x *= scale;
            Extent const extent = FindExtent(points);
            double worst = 0.0;
            for (double x : points)
                worst = std::max(worst, std::abs(x - double{static_cast<float>(x)}));
            EXPECT_LE(worst, engine::FindFloatError(extent));
            if (!engine::AreFloatsEnough(extent)) continue;
            EXPECT_LE(worst, 1e-6 * extent.GetDiagonal());
            ++numEnough;
        }
    }
    EXPECT_EQ(numEnough, 10) << "as far as nine sizes away, of either scale";
    EXPECT_FALSE(engine::AreFloatsEnough({{1e39, 0, 0}, {2e39, 1e39, 1e39}}));
}

// A short number: what is left has the size of the box, and all digits of the far positions.
TEST(Extent, AnOriginIsRoundAndSubtractedWithoutLoss) {
    for (double distance : {100.0, 12345.6789, 5411932.5}) {
        auto const points = MakePoints(distance, -distance, 3.0 * distance);
        Extent const extent = FindExtent(points);
        auto const origin = engine::FindOrigin(extent);
        auto const relative = engine::Subtract(points, origin);
        double const unit = std::exp2(std::floor(std::log2(extent.GetDiagonal())));
        for (double x : origin) EXPECT_EQ(std::remainder(x, unit), 0.0) << x;
        EXPECT_LE(FindExtent(relative).GetFarthest(), extent.GetDiagonal());
        for (size_t i = 0; i < points.size(); ++i)
            EXPECT_EQ(relative[i] + origin[i % 3], points[i]);
    }
}

TEST(Extent, NearTheOriginNothingIsSubtracted) {
    std::array<double, 3> const zero{};
    EXPECT_EQ(engine::FindOrigin(FindExtent(MakePoints(0.3, -0.4, 0.5))), zero);
    auto const aside = FindExtent(MakePoints(10.0, 0.0, 0.0));
    EXPECT_EQ(engine::FindOrigin(aside), (std::array<double, 3>{10.0, 0.0, 0.0}));
    EXPECT_EQ(engine::FindFloatOrigin(aside), zero) << "floats hold it as it is";
    auto const far = FindExtent(MakePoints(1e6, 0.0, 0.0));
    EXPECT_EQ(engine::FindFloatOrigin(far), engine::FindOrigin(far));
}

TEST(Extent, PointsInOnePlaceAreTheirOwnOrigin) {
    std::vector<double> const points{1.1, 2.2, 3.3, 1.1, 2.2, 3.3};
    EXPECT_EQ(engine::FindOrigin(FindExtent(points)), (std::array<double, 3>{1.1, 2.2, 3.3}));
}

}  // namespace
}  // namespace limn
