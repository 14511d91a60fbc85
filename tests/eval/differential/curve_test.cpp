// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/curve.h"

#include <cmath>

#include <gtest/gtest.h>

namespace limn {
namespace {

using eval::Curve;
using eval::CurveRule;
using eval::DoubleLanes;

Curve MakePolygon(int n) {
    Curve curve{{}, true};
    for (int i = 0; i < n; ++i) {
        double const angle = 2.0 * std::acos(-1.0) * i / n;
        curve.points.push_back({std::cos(angle), std::sin(angle), 0.0, 0.0});
    }
    return curve;
}

/// Mean distance from the mean point.
double RadiusOf(Curve const& curve) {
    DoubleLanes mean = DoubleLanes::Zero();
    for (DoubleLanes const& p : curve.points) mean += p / static_cast<double>(curve.points.size());
    double radius = 0.0;
    for (DoubleLanes const& p : curve.points)
        radius += std::sqrt((p - mean).square().sum()) / static_cast<double>(curve.points.size());
    return radius;
}

// A regular n-gon's differential B-spline has 2 (1 - cos t) / t^2 of the spatial one's radius, t =
// 2 pi / n.
TEST(Curve, PolygonsShrinkByAKnownFactor) {
    for (auto const& [n, tolerance] : {std::pair{4, 3e-4}, {6, 3e-5}, {8, 2e-5}, {16, 1e-5}}) {
        Curve spatial = MakePolygon(n);
        auto const [differential, report] =
            eval::RefineCurveDifferentially(spatial, CurveRule::CubicBSpline, 6);
        for (int level = 0; level < 6; ++level)
            spatial = eval::SubdivideCurve(spatial, CurveRule::CubicBSpline);
        double const t = 2.0 * std::acos(-1.0) / n;
        EXPECT_NEAR(RadiusOf(differential) / RadiusOf(spatial), 2.0 * (1.0 - std::cos(t)) / (t * t),
                    tolerance)
            << n;
        EXPECT_LT(report.residual, 1e-10);
        EXPECT_LT(report.compatibilityDefect, 1e-14);
    }
}

// The digits that coordinates lose by their size are all that a translation costs; 2^-20 keeps
// moved points exact.
TEST(Curve, AMovedCurveGivesTheMovedResult) {
    for (bool isClosed : {true, false}) {
        Curve here = MakePolygon(9);
        here.isClosed = isClosed;
        for (DoubleLanes& p : here.points) p = (p * 0x1p20).round() / 0x1p20;
        Curve there = here;
        DoubleLanes const offset(30000.0, -125.0, 10.0, 0.0);
        for (DoubleLanes& p : there.points) p += offset;
        Curve const fine = eval::RefineCurveDifferentially(here, CurveRule::CubicBSpline, 5).curve,
                    moved =
                        eval::RefineCurveDifferentially(there, CurveRule::CubicBSpline, 5).curve;
        for (size_t i = 0; i < fine.points.size(); ++i) {
            EXPECT_LT((moved.points[i] - fine.points[i] - offset).abs().maxCoeff(),
                      0x1p-53 * 8.0 * 30000.0)
                << i;
        }
    }
}

// An open parabola has the same delta everywhere, so it is found again, its ends included, by both
// rules.
TEST(Curve, ParabolasAreReproduced) {
    for (CurveRule rule : {CurveRule::CubicBSpline, CurveRule::FourPoint}) {
        Curve curve;
        for (int i = 0; i <= 5; ++i) curve.points.push_back({1.0 * i, 1.0 * i * i, 0.0, 0.0});
        Curve const fine = eval::RefineCurveDifferentially(curve, rule, 3).curve;
        ASSERT_EQ(fine.points.size(), 41u);
        for (size_t i = 0; i < fine.points.size(); ++i) {
            double const x = static_cast<double>(i) / 8.0;
            EXPECT_NEAR(fine.points[i][0], x, 1e-12);
            EXPECT_NEAR(fine.points[i][1], x * x, 1e-11);
        }
    }
}

// Closed four-point: old points stay; between them stands the cubic through the four round about,
// in whose middle it is (-1, 9, 9, -1) / 16 of them.
TEST(Curve, FourPointInterpolates) {
    Curve const coarse = MakePolygon(7);
    Curve const fine = eval::SubdivideCurve(coarse, CurveRule::FourPoint);
    ASSERT_EQ(fine.points.size(), 14u);
    for (size_t i = 0; i < 7; ++i) {
        auto const at = [&](size_t k) { return coarse.points[(i + k) % 7]; };
        EXPECT_TRUE((fine.points[2 * i] == at(0)).all());
        DoubleLanes const middle = (9.0 * (at(0) + at(1)) - at(6) - at(2)) / 16.0;
        EXPECT_LT((fine.points[2 * i + 1] - middle).abs().maxCoeff(), 1e-15);
    }
}

TEST(Curve, TwoPointsStayALine) {
    Curve const fine = eval::RefineCurveDifferentially({{{0, 0, 0, 0}, {4, 0, 0, 0}}, false},
                                                       CurveRule::FourPoint, 2)
                           .curve;
    ASSERT_EQ(fine.points.size(), 5u);
    for (size_t i = 0; i < 5; ++i) EXPECT_NEAR(fine.points[i][0], static_cast<double>(i), 1e-14);
}

}  // namespace
}  // namespace limn
