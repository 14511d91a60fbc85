// SPDX-License-Identifier: Apache-2.0
//
// Cascades that move heights over a plane only.

#include <array>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "eval/cascade/cascade.h"
#include "support/cascade_meshes.h"
#include "support/fit_meshes.h"

namespace limn {
namespace {

using eval::CascadeSolver;
using far_ext::BoundaryRule;
using far_ext::CascadeLevel;
using test::kSolvers;
using test::LoadMesh;
using test::PointAt;
using test::QuarterLevels;

TEST(CascadeGraph, TheBaseStaysToTheBitAndHeightsMove) {
    auto const scene = LoadMesh("gridholetri");
    auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
    for (auto const& [solver, tolerance] : kSolvers) {
        eval::Cascade<double> cascade(
            scene.positions, {},
            {.solver = solver, .tolerance = tolerance, .width = 0.3, .isGraph = true});
        eval::Cascade<double> start(scene.positions, {},
                                    {.solver = CascadeSolver::Jacobi, .width = 0.0});
        for (auto const& level : levels) {
            cascade.Step(level, 20);
            start.Step(level, 0);
        }
        auto const points = cascade.GetPositions(), flat = start.GetPositions();
        double moved = 0.0;
        for (size_t i = 0; i < points.size(); i += 3) {
            EXPECT_EQ(points[i], flat[i]);
            EXPECT_EQ(points[i + 1], flat[i + 1]);
            moved = std::max(moved, std::abs(points[i + 2] - flat[i + 2]));
        }
        EXPECT_GT(moved, 1e-3);
    }
}

TEST(CascadeGraph, APlaneWithAFixedBoundaryStays) {
    for (bool isQuads : {false, true}) {
        auto scene = isQuads ? test::MakeGridWithHole(6, 5) : LoadMesh("gridholetri");
        for (size_t i = 0; i < scene.positions.size(); i += 3)
            scene.positions[i + 2] = 0.7 * scene.positions[i] - 1.3 * scene.positions[i + 1] + 2;
        auto const levels = QuarterLevels(scene, 3, BoundaryRule::Fixed);
        for (auto const& [solver, tolerance] : kSolvers) {
            eval::Cascade<double> cascade(
                scene.positions, {},
                {.solver = solver, .tolerance = tolerance, .width = 0.5, .isGraph = true});
            for (auto const& level : levels) cascade.Step(level, 20);
            EXPECT_LT(test::LargestDifference(cascade.GetPositions(), cascade.GetStartPositions()),
                      1e-12);
            auto const points = cascade.GetPositions();
            for (size_t i = 0; i < points.size(); i += 3)
                EXPECT_NEAR(points[i + 2], 0.7 * points[i] - 1.3 * points[i + 1] + 2, 1e-12);
        }
    }
}

// (M + L) z = M z0 on the plane is one linear problem per level: assembled triangle by triangle and
// solved densely it gives the exact cascade's heights; another step has the same operator and the
// same answer; all levels have the same angles.
TEST(CascadeGraph, IsADirectSolveOnThePlanesMetric) {
    auto const scene = LoadMesh("gridholetri");
    auto const levels = QuarterLevels(scene, 2, BoundaryRule::Fixed);
    auto const refiner = test::MakeRefiner(scene, 2);
    auto const mesh = far_ext::MakeCascadeMesh(*refiner, 2);
    double const sigma = 0.5, a = sigma * sigma / 2;
    eval::Cascade<double> cascade(
        scene.positions, {}, {.solver = CascadeSolver::Exact, .width = sigma, .isGraph = true});
    eval::Cascade<double> start(scene.positions, {},
                                {.solver = CascadeSolver::Jacobi, .width = 0.0});
    std::vector<double> angles;
    for (auto const& level : levels) {
        auto const report = cascade.Step(level, 1);
        EXPECT_EQ(report.sweeps, 1);
        angles.push_back(report.minAngleRadians);
        start.Step(level, 0);
    }
    EXPECT_NEAR(angles[1], angles[0], 1e-12);

    auto const x0 = start.GetPositions();
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(mesh.numVertices, mesh.numVertices);
    Eigen::VectorXd rightSide = Eigen::VectorXd::Zero(mesh.numVertices);
    for (size_t face = 0; face < mesh.faces.size(); face += 3) {
        std::array<Eigen::Vector3d, 3> p;
        for (size_t k = 0; k < 3; ++k) {
            p[k] = PointAt(x0, mesh.faces[face + k]);
            p[k][2] = 0.0;
        }
        double const area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
        for (size_t i = 0; i < 3; ++i) {
            Index const vertex = mesh.faces[face + i];
            A(vertex, vertex) += area / 3;
            rightSide[vertex] += area / 3 * PointAt(x0, vertex)[2];
            for (size_t j = 0; j < 3; ++j) {
                A(vertex, mesh.faces[face + j]) +=
                    a * (p[(i + 2) % 3] - p[(i + 1) % 3]).dot(p[(j + 2) % 3] - p[(j + 1) % 3]) /
                    (4 * area);
            }
        }
    }
    for (Index vertex = 0; vertex < mesh.numVertices; ++vertex) {
        if (!refiner->GetLevel(2).IsVertexBoundary(vertex)) continue;
        A.row(vertex).setZero();
        A(vertex, vertex) = 1.0;
        rightSide[vertex] = PointAt(x0, vertex)[2];
    }
    Eigen::VectorXd const heights = A.partialPivLu().solve(rightSide);
    auto const points = cascade.GetPositions();
    for (Index vertex = 0; vertex < mesh.numVertices; ++vertex)
        EXPECT_NEAR(PointAt(points, vertex)[2], heights[vertex], 1e-12);

    auto const edges = cascade.GetOperator().edges, masses = cascade.GetOperator().masses;
    cascade.Repeat(1);
    EXPECT_EQ(cascade.GetOperator().edges, edges);
    EXPECT_EQ(cascade.GetOperator().masses, masses);
    EXPECT_EQ(cascade.GetPositions(), points);
}

// Widths are filtered along: those of level 1 are the ones that level 2 starts from, over the
// plane.
TEST(CascadeGraph, FilteredWidthsEnterTheNextLevel) {
    auto const scene = LoadMesh("gridholetri");
    std::vector<double> widths;
    for (Index i = 0; i < scene.cage.numVertices; ++i) widths.push_back(i % 3 == 0 ? 0.6 : 0.1);
    auto const levels = QuarterLevels(scene, 2, BoundaryRule::Fixed);
    eval::Cascade<double> cascade(scene.positions, widths,
                                  {.solver = CascadeSolver::Exact, .isGraph = true});
    cascade.Step(levels.front(), 1);
    auto flat = cascade.GetPositions();
    auto const filtered = cascade.GetWidths();
    for (size_t i = 2; i < flat.size(); i += 3) flat[i] = 0.0;
    cascade.Step(levels.back(), 1);

    auto const refiner = test::MakeRefiner(scene, 2);
    CascadeLevel const level =
        far_ext::BuildCascadeLevel(far_ext::MakeCascadeMesh(*refiner, 2), {}, BoundaryRule::Fixed);
    eval::Cascade<double> again(flat, filtered, {.solver = CascadeSolver::Jacobi});
    again.Step(level, 0);
    ASSERT_EQ(level.vertices, levels.back().vertices);
    auto const &found = cascade.GetOperator(), &expected = again.GetOperator();
    for (size_t k = 0; k < expected.edges.size(); ++k)
        EXPECT_NEAR(found.edges[k], expected.edges[k], 1e-14);
    for (size_t i = 0; i < expected.masses.size(); ++i)
        EXPECT_NEAR(found.masses[i], expected.masses[i], 1e-14);
}

}  // namespace
}  // namespace limn
