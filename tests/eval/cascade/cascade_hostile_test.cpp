// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <gtest/gtest.h>

#include "eval/cascade/cascade.h"
#include "support/cascade_meshes.h"
#include "support/errors.h"
#include "support/fit_meshes.h"

namespace limn {
namespace {

using eval::CascadeOptions;
using eval::CascadeSolver;
using far_ext::BoundaryRule;
using far_ext::CascadeLevel;
using test::AreFinite;
using test::Filter;
using test::kSolvers;
using test::LoadMesh;
using test::QuarterLevels;
using test::Transform;

/// Every solver's result is finite and no larger than the mesh, in a cascade of three levels and
/// two more updates of the metric.
template <class Scalar = double>
void ExpectFinite(engine::Scene const& scene, double width, std::string const& name,
                  BoundaryRule rule = BoundaryRule::Fixed, double growth = 0.01) {
    auto const levels = QuarterLevels(scene, 3, rule);
    for (auto const& [solver, tolerance] : kSolvers) {
        if (std::is_same_v<Scalar, float> && solver != CascadeSolver::Jacobi) continue;
        eval::Cascade<Scalar> cascade(scene.positions, {},
                                      {.solver = solver, .tolerance = tolerance, .width = width});
        for (auto const& level : levels) {
            auto const report = cascade.Step(level, 30);
            EXPECT_TRUE(std::isfinite(report.residual) && std::isfinite(report.minAngleRadians) &&
                        std::isfinite(report.areaRatio))
                << name;
        }
        for (int k = 0; k < 2; ++k) cascade.Repeat(30);
        EXPECT_TRUE(AreFinite(cascade.GetPositions()))
            << name << ", solver " << static_cast<int>(solver);
        EXPECT_LE(test::BoxDiagonal(cascade.GetPositions()),
                  (1 + growth) * test::BoxDiagonal(scene.positions))
            << name;
    }
}

TEST(CascadeHostile, FacesWithoutAreaStayFinite) {
    auto icosa = LoadMesh("icosa");
    ExpectFinite(icosa, 0.3, "as it is");
    auto doubled = icosa;
    std::copy_n(doubled.positions.begin(), 3,
                doubled.positions.begin() + 3);  // 0 and 1 are the ends of an edge
    ExpectFinite(doubled, 0.3, "a doubled vertex");
    ExpectFinite<float>(doubled, 0.3, "a doubled vertex");
    auto line = icosa;
    for (size_t i = 0; i < line.positions.size(); i += 3)
        line.positions[i + 1] = line.positions[i + 2] = 0.0;
    ExpectFinite(line, 0.3, "on a line", BoundaryRule::Fixed,
                 0.1);  // unpreconditioned gradients are far from done there
    ExpectFinite<float>(line, 0.3, "on a line");
    auto folded = icosa;
    for (size_t i = 2; i < folded.positions.size(); i += 3) folded.positions[i] = 0.0;
    ExpectFinite(folded, 0.3, "in a plane, both sides on one another");
    auto quads = test::MakeCube();
    for (size_t i = 2; i < quads.positions.size(); i += 3) quads.positions[i] = 0.0;
    ExpectFinite(quads, 0.3, "quads in a plane, four of them without area");
    ExpectFinite<float>(quads, 0.3, "quads in a plane, four of them without area");
}

// Such meshes have one answer whoever solves: degenerate faces leave the operator symmetric and
// definite. Entries of slivers are up to 1 / 1e-7 times the others, which is what the factorisation
// loses of its sixteen digits; and at a vertex of two quads that lie on one another, each with
// three corners on a line, all of them are slivers.
TEST(CascadeHostile, SolversAgreeOnFacesWithoutArea) {
    auto doubled = LoadMesh("icosa");
    std::copy_n(doubled.positions.begin(), 3, doubled.positions.begin() + 3);
    auto folded = LoadMesh("icosa");
    for (size_t i = 2; i < folded.positions.size(); i += 3) folded.positions[i] = 0.0;
    auto quads = test::MakeCube();
    for (size_t i = 2; i < quads.positions.size(); i += 3) quads.positions[i] = 0.0;
    auto const onAnother = test::MakeFan(2, Sdc::SCHEME_CATMARK, 0.1, 0.05);
    for (auto const& [scene, share] :
         {std::pair{doubled, 1e-8}, {folded, 1e-8}, {quads, 1e-8}, {onAnother, 1e-5}}) {
        auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
        eval::Cascade<double> cascade(scene.positions, {}, {.tolerance = 1e-10, .width = 0.2});
        for (auto const& level : levels) EXPECT_TRUE(cascade.Step(level, 4000).converged);
        auto const exact = Filter(scene, levels, {.solver = CascadeSolver::Exact, .width = 0.2});
        EXPECT_LT(test::LargestDifference(cascade.GetPositions(), exact),
                  share * test::BoxDiagonal(scene.positions));
    }
}

// Directions of conjugate gradients are like M X, and their curvature like (M X)^2 M: the eighth
// power of a length. In single precision sweeps alone are done; the fourth power is what a
// triangle's area needs.
TEST(CascadeHostile, TinyAndHugeMeshesHaveTheSameShape) {
    auto const scene = LoadMesh("gridholetri");
    auto const levels = QuarterLevels(scene, 2, BoundaryRule::Fixed);
    auto const filter = [&]<class Scalar>(Scalar, CascadeOptions options, double scale) {
        options.width = 0.2 * scale;
        eval::Cascade<Scalar> cascade(
            Transform(scene.positions, scale * Eigen::Matrix3d::Identity(),
                      Eigen::Vector3d::Zero()),
            {}, options);
        for (auto const& level : levels) {
            auto const report = cascade.Step(level, 30);
            EXPECT_TRUE(std::isfinite(report.residual)) << scale;
            EXPECT_FALSE(report.isMetricFrozen) << scale;
        }
        EXPECT_GT(test::LargestDifference(cascade.GetPositions(), cascade.GetStartPositions()),
                  0.01 * scale);
        return Transform(cascade.GetPositions(), Eigen::Matrix3d::Identity() / scale,
                         Eigen::Vector3d::Zero());
    };
    for (auto const& [solver, tolerance] : kSolvers) {
        CascadeOptions const options{.solver = solver, .tolerance = tolerance};
        auto const points = filter(1.0, options, 1.0);
        for (double scale : {1e-30, 1e-15, 1e15, 1e30})
            EXPECT_LT(test::LargestDifference(filter(1.0, options, scale), points), 1e-12) << scale;
    }
    CascadeOptions const sweeps{.solver = CascadeSolver::Jacobi};
    for (double scale : {1e-8, 1e-4, 1e4, 1e8})
        EXPECT_LT(test::LargestDifference(filter(1.0f, sweeps, scale), filter(1.0f, sweeps, 1.0)),
                  1e-4)
            << scale;
}

// Where squares of lengths leave the range of numbers nothing moves any more; inverses of what is
// left of areas would.
TEST(CascadeHostile, MeshesTooTinyForTheirSquaresStayFinite) {
    auto const scene = LoadMesh("gridholetri");
    auto const levels = QuarterLevels(scene, 2, BoundaryRule::Fixed);
    auto const run = [&]<class Scalar>(Scalar, CascadeOptions options, double scale) {
        options.width = 0.2 * scale;
        eval::Cascade<Scalar> cascade(
            Transform(scene.positions, scale * Eigen::Matrix3d::Identity(),
                      Eigen::Vector3d::Zero()),
            {}, options);
        for (auto const& level : levels) cascade.Step(level, 30);
        auto const points = cascade.GetPositions();
        EXPECT_TRUE(AreFinite(points)) << scale;
        EXPECT_LE(test::BoxDiagonal(points), 1.01 * scale * test::BoxDiagonal(scene.positions))
            << scale;
    };
    for (int exponent = -320; exponent < -30; exponent += 2) {
        for (auto const& [solver, tolerance] : kSolvers)
            run(1.0, {.solver = solver, .tolerance = tolerance}, std::pow(10.0, exponent));
    }
    for (int exponent = -40; exponent < -6; ++exponent)
        run(1.0f, {.solver = CascadeSolver::Jacobi}, std::pow(10.0, exponent));
}

TEST(CascadeHostile, WhatIsNoNumberOrTooLargeIsRefused) {
    auto const scene = LoadMesh("icosa");
    auto const bad = ErrorCode::BadMesh;
    auto const code = [&](double coordinate, double width, bool isFloat = false) {
        auto points = scene.positions;
        points[7] = coordinate;
        return test::CodeOf([&] {
            CascadeOptions const options{.solver = CascadeSolver::Jacobi, .width = width};
            if (isFloat)
                eval::Cascade<float>(points, {}, options);
            else
                eval::Cascade<double>(points, {}, options);
        });
    };
    double const infinity = std::numeric_limits<double>::infinity(),
                 notANumber = std::numeric_limits<double>::quiet_NaN();
    for (double coordinate : {notANumber, infinity, -infinity, 1e150, -1e49})
        EXPECT_EQ(code(coordinate, 0.1), bad) << coordinate;
    for (double width : {notANumber, infinity, 1e150}) EXPECT_EQ(code(1.0, width), bad) << width;
    EXPECT_FALSE(code(1e47, 0.1));
    EXPECT_EQ(code(1e10, 0.1, true), bad);
    EXPECT_FALSE(code(1e9, 0.1, true));
    std::vector<double> widths(12, 0.1);
    widths[5] = notANumber;
    EXPECT_EQ(test::CodeOf([&] { eval::Cascade<double>(scene.positions, widths, {}); }), bad);
}

// At the largest size that is let in, every solver's numbers are finite.
TEST(CascadeHostile, TheLargestMeshesStayFinite) {
    for (auto const& [scene, size] :
         {std::pair{LoadMesh("icosa"), 1.6180339887498949}, {LoadMesh("gridholetri"), 7.0}}) {
        auto large = scene;
        large.positions = Transform(scene.positions, 1e48 / size * Eigen::Matrix3d::Identity(),
                                    Eigen::Vector3d::Zero());
        ExpectFinite(large, 1e47, "1e48");
        large.positions = Transform(scene.positions, 1e9 / size * Eigen::Matrix3d::Identity(),
                                    Eigen::Vector3d::Zero());
        ExpectFinite<float>(large, 1e8, "1e9");
    }
}

TEST(CascadeHostile, APointStaysAPoint) {
    for (auto scene : {LoadMesh("icosa"), test::MakeCube(), LoadMesh("gridholetri")}) {
        for (size_t i = 0; i < scene.positions.size(); ++i)
            scene.positions[i] = 0.1 * static_cast<double>(i % 3 + 1);
        auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
        for (auto const& [solver, tolerance] : kSolvers) {
            eval::Cascade<double> cascade(scene.positions, {},
                                          {.solver = solver, .tolerance = tolerance, .width = 0.3});
            for (auto const& level : levels) EXPECT_EQ(cascade.Step(level, 20).residual, 0.0);
            EXPECT_EQ(cascade.GetPositions(), cascade.GetStartPositions());
        }
    }
}

TEST(CascadeHostile, ValencesOfThreeAndOfSixtyFourStayFinite) {
    for (int n : {3, 64}) {
        auto const scene = test::MakeBipyramid(n);
        for (double width : {0.01, 0.1, 1.0})
            ExpectFinite(scene, width, "bipyramid of " + std::to_string(n));
        ExpectFinite<float>(scene, 0.1, "bipyramid of " + std::to_string(n));
    }
    ExpectFinite(test::LoadShape("catmark_pole64"), 0.1, "pole of 64");
}

// All three vertices lie on the boundary: with a fixed one nothing is unknown at level 1, and
// nothing ever moves out of the plane; with a natural one the triangle shrinks towards its middle.
TEST(CascadeHostile, ASingleTriangleStaysOrShrinksByItsBoundaryRule) {
    auto const scene = test::MakeScene({0, 0, 1, 1, 0, 1, 0, 1, 1}, {{0, 1, 2}}, Sdc::SCHEME_LOOP);
    ExpectFinite(scene, 0.3, "fixed", BoundaryRule::Fixed);
    ExpectFinite(scene, 0.3, "natural", BoundaryRule::Natural);
    auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
    EXPECT_EQ(levels.front().numUnknowns, 0);
    eval::Cascade<double> fixed(scene.positions, {}, {.tolerance = 1e-6, .width = 0.3});
    for (auto const& level : levels) {
        auto const report = fixed.Step(level, 100);
        EXPECT_TRUE(report.converged);
        EXPECT_FALSE(report.isMetricFrozen) << "a right triangle is not degenerate";
    }
    EXPECT_LT(test::LargestDifference(fixed.GetPositions(), fixed.GetStartPositions()), 1e-15);
    auto const shrunk = Filter(scene, QuarterLevels(scene, 3, BoundaryRule::Natural),
                               {.solver = CascadeSolver::Exact, .width = 0.3});
    EXPECT_LT(test::BoxDiagonal(shrunk), 0.95 * test::BoxDiagonal(scene.positions));
}

TEST(CascadeHostile, AnEmptyMeshIsDoneAtOnce) {
    CascadeLevel const level = far_ext::BuildCascadeLevel({}, {}, BoundaryRule::Fixed);
    EXPECT_EQ(level.GetNumRows(), 0);
    for (auto const& [solver, tolerance] : kSolvers) {
        eval::Cascade<double> cascade({}, {},
                                      {.solver = solver, .tolerance = tolerance, .width = 0.3});
        EXPECT_EQ(cascade.Step(level, 10).unknowns, 0);
        EXPECT_TRUE(cascade.GetPositions().empty());
    }
}

TEST(CascadeHostile, WidthsThatDoNotFitAreRefused) {
    auto const scene = LoadMesh("icosa");
    auto const code = [&](std::vector<double> const& widths, double width) {
        return test::CodeOf(
            [&] { eval::Cascade<double>(scene.positions, widths, {.width = width}); });
    };
    EXPECT_EQ(code({}, -1.0), ErrorCode::BadOption);
    EXPECT_EQ(code({1.0, 2.0}, -1.0), ErrorCode::BadOption);
    EXPECT_EQ(code(std::vector<double>(12, 0.1), 0.3), ErrorCode::BadOption);
    EXPECT_FALSE(code(std::vector<double>(12, 0.1), -1.0));
    EXPECT_EQ(test::CodeOf([&] {
                  eval::Cascade<float>(scene.positions, {},
                                       {.solver = CascadeSolver::Exact, .width = 0.3});
              }),
              ErrorCode::BadOption);
}

}  // namespace
}  // namespace limn
