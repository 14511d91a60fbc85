// SPDX-License-Identifier: Apache-2.0
#include "engine/differential/monotone_curve.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/differential/curvature_edit.h"

namespace limn {
namespace {

using engine::MonotoneCurve;

TEST(MonotoneCurve, GoesThroughItsPointsAndKeepsItsEnds) {
    std::vector<std::array<double, 2>> const points{{0.1, 0.3}, {0.2, 0.9}, {0.7, 0.4}, {0.8, 0.4}};
    MonotoneCurve const curve(points);
    for (auto const& [x, y] : points) EXPECT_NEAR(curve(x), y, 1e-15);
    for (double x : {0.0, 0.05}) EXPECT_EQ(curve(x), 0.3);
    for (double x : {0.81, 1.0}) EXPECT_EQ(curve(x), 0.4);
}

TEST(MonotoneCurve, TwoPointsMakeALine) {
    MonotoneCurve const curve({{0.0, 0.0}, {1.0, 1.0}});
    for (int i = 0; i <= 100; ++i) EXPECT_NEAR(curve(0.01 * i), 0.01 * i, 1e-15);
}

// A plain cubic through a step overshoots it.
TEST(MonotoneCurve, NeverOvershoots) {
    std::vector<std::array<double, 2>> const points{{0.0, 0.0}, {0.4, 0.02}, {0.45, 0.98},
                                                    {0.5, 1.0}, {0.9, 1.0},  {1.0, -2.0}};
    MonotoneCurve const curve(points);
    for (size_t i = 0; i + 1 < points.size(); ++i) {
        auto const [low, high] = std::minmax(points[i][1], points[i + 1][1]);
        double const sign = points[i + 1][1] >= points[i][1] ? 1.0 : -1.0;
        double last = points[i][1];
        for (int k = 0; k <= 50; ++k) {
            double const y = curve(points[i][0] + (points[i + 1][0] - points[i][0]) * k / 50.0);
            EXPECT_GE(y, low - 1e-14);
            EXPECT_LE(y, high + 1e-14);
            EXPECT_GE(sign * (y - last), -1e-14);
            last = y;
        }
    }
}

// Its slopes agree where cubics meet.
TEST(MonotoneCurve, IsSmooth) {
    MonotoneCurve const curve({{0.0, 0.0}, {0.3, 0.1}, {0.6, 0.7}, {1.0, 1.0}});
    for (double x : {0.3, 0.6}) {
        double const before = (curve(x) - curve(x - 1e-6)) / 1e-6,
                     after = (curve(x + 1e-6) - curve(x)) / 1e-6;
        EXPECT_NEAR(before, after, 1e-4);
    }
}

// The paper's filter, steep in the middle, by 25 points that lie close there.
TEST(MonotoneCurve, ThePapersFilterIsMetByTwentyFivePoints) {
    std::vector<std::array<double, 2>> points;
    for (int j = -12; j <= 12; ++j) {
        double const share = j / 12.0, x = 0.5 + 0.5 * std::copysign(std::pow(share, 6), share);
        points.push_back({x, engine::PolariseCurvature(x)});
    }
    MonotoneCurve const curve(points);
    for (int i = 0; i <= 10000; ++i)
        EXPECT_NEAR(curve(1e-4 * i), engine::PolariseCurvature(1e-4 * i), 0.004);
}

}  // namespace
}  // namespace limn
