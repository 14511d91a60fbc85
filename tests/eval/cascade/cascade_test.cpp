// SPDX-License-Identifier: Apache-2.0
#include "eval/cascade/cascade.h"

#include <list>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opensubdiv/osd/cpuEvaluator.h>

#include "far_ext/cascade/cascade_stencils.h"
#include "support/cascade_meshes.h"

namespace limn {
namespace {

using eval::CascadeOptions;
using eval::CascadeSolver;
using far_ext::BoundaryRule;
using far_ext::CascadeLevel;
using test::BisectLevels;
using test::EdgeLengths;
using test::Filter;
using test::LoadMesh;
using test::MeasureEdges;
using test::QuarterLevels;

struct Golden {
    char const* mesh;
    int levels;
};

class CascadeGolden : public testing::TestWithParam<Golden> {
protected:
    std::string Name(std::string const& what, int count) const {
        return fmt::format("cascade/{}_cas_{}_L{}.obj", GetParam().mesh, what, count);
    }
    engine::Scene scene = LoadMesh(GetParam().mesh);
    EdgeLengths lengths = MeasureEdges(scene);
    double box = test::BoxDiagonal(scene.positions);
    std::list<CascadeLevel> levels = QuarterLevels(scene, GetParam().levels, BoundaryRule::Natural);
    double Difference(std::vector<double> const& points, std::string const& what) const {
        return test::LargestDifference(points, test::LoadPoints(Name(what, GetParam().levels))) /
               box;
    }
};

TEST_P(CascadeGolden, ExactSolvesMeetTheReference) {
    EXPECT_LT(Difference(Filter(scene, levels,
                                {.solver = CascadeSolver::Exact, .width = 0.12 * lengths.mean}),
                         "exact"),
              1e-8);
}

TEST_P(CascadeGolden, JacobiSweepsByTheAPrioriRuleMeetTheReference) {
    EXPECT_LT(Difference(Filter(scene, levels,
                                {.solver = CascadeSolver::Jacobi, .width = 0.12 * lengths.mean}),
                         "jacobi"),
              1e-10);
}

TEST_P(CascadeGolden, ConjugateGradientsByTheAPrioriRuleMeetTheReference) {
    EXPECT_LT(Difference(Filter(scene, levels,
                                {.solver = CascadeSolver::ConjugateGradients,
                                 .width = 0.12 * lengths.mean}),
                         "cg"),
              1e-6);
}

TEST_P(CascadeGolden, LocalWidthsMeetTheReference) {
    std::vector<double> widths;
    for (double length : lengths.atVertices) widths.push_back(0.12 * length);
    EXPECT_LT(
        Difference(Filter(scene, levels, {.solver = CascadeSolver::Exact}, widths), "local12"),
        1e-8);
}

TEST_P(CascadeGolden, BisectionMeetsTheReference) {
    auto const halves = BisectLevels(scene, 4, BoundaryRule::Natural);
    auto const points =
        Filter(scene, halves, {.solver = CascadeSolver::Exact, .width = 0.12 * lengths.mean});
    EXPECT_LT(test::LargestDifference(points, test::LoadPoints(Name("bisect", 4))) / box, 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Meshes, CascadeGolden,
                         testing::Values(Golden{"icosa", 3}, Golden{"torustri", 2},
                                         Golden{"gridholetri", 3}),
                         [](auto const& golden) { return std::string(golden.param.mesh); });

TEST(Cascade, FixedBoundaryMeetsItsReference) {
    auto const scene = LoadMesh("gridholetri");
    double const width = 0.12 * MeasureEdges(scene).mean;
    auto const points = Filter(scene, QuarterLevels(scene, 3, BoundaryRule::Fixed),
                               {.solver = CascadeSolver::Exact, .width = width});
    EXPECT_LT(
        test::LargestDifference(points, test::LoadPoints("cascade/gridholetri_cas_fix_L3.obj")) /
            test::BoxDiagonal(scene.positions),
        1e-8);
}

// Residual mode: a reference measured 2.5e-7 of the box at most.
TEST(Cascade, ConjugateGradientsToAResidualAreNearTheExactOnes) {
    auto const scene = LoadMesh("icosa");
    auto const levels = QuarterLevels(scene, 4, BoundaryRule::Fixed);
    double const width = 0.15 * MeasureEdges(scene).mean;
    auto const exact = Filter(scene, levels, {.solver = CascadeSolver::Exact, .width = width});
    eval::Cascade<double> cascade(scene.positions, {}, {.tolerance = 1e-6, .width = width});
    for (auto const& level : levels) EXPECT_TRUE(cascade.Step(level, 1000).converged);
    EXPECT_LT(
        test::LargestDifference(cascade.GetPositions(), exact) / test::BoxDiagonal(scene.positions),
        1e-6);
}

// On a sphere the fixed point is r = (r0 + sqrt(r0^2 - 4 sigma^2)) / 2; what is listed is measured
// on the polyhedron.
TEST(Cascade, ASphereShrinksToItsFixedPoint) {
    auto const icosa = LoadMesh("icosa");
    auto const base = test::MakeRefiner(icosa, 3);
    std::vector<std::vector<Index>> faces;
    for (Index face = 0; face < base->GetLevel(3).GetNumFaces(); ++face) {
        auto const f = base->GetLevel(3).GetFaceVertices(face);
        faces.push_back({f[0], f[1], f[2]});
    }
    std::vector<double> points = icosa.positions;  // every level moved out to the sphere
    for (int k = 1; k <= 3; ++k) {
        auto const mesh = far_ext::MakeCascadeMesh(*base, k);
        std::vector<double> fine(3 * static_cast<size_t>(mesh.numVertices), 0.0);
        for (size_t i = 0; i < fine.size() / 3; ++i) {
            for (int j = mesh.parentOffsets[i]; j < mesh.parentOffsets[i + 1]; ++j) {
                for (size_t c = 0; c < 3; ++c)
                    fine[3 * i + c] += points[3 * static_cast<size_t>(mesh.parents[j]) + c];
            }
            double const length = std::hypot(fine[3 * i], fine[3 * i + 1], fine[3 * i + 2]);
            for (size_t c = 0; c < 3; ++c) fine[3 * i + c] /= length;
        }
        points = fine;
    }
    auto const sphere = test::MakeScene(points, faces, Sdc::SCHEME_LOOP);
    auto const levels = QuarterLevels(sphere, 2, BoundaryRule::Fixed);
    double const widths[] = {0.1, 0.25, 0.4}, twoLevels[] = {0.98721, 0.93124, 0.81972},
                 settled[] = {0.98720, 0.93012, 0.79640};
    for (size_t i = 0; i < 3; ++i) {
        eval::Cascade<double> cascade(sphere.positions, {},
                                      {.tolerance = 1e-10, .width = widths[i]});
        for (auto const& level : levels) cascade.Step(level, 1000);
        EXPECT_NEAR(test::MeanRadius(cascade.GetPositions()), twoLevels[i], 1e-3);
        for (int repeat = 0; repeat < 30; ++repeat) cascade.Repeat(1000);
        EXPECT_NEAR(test::MeanRadius(cascade.GetPositions()), settled[i], 1e-3);
    }
}

// M and L against the finite elements they are: m_T = |T| / 3 and l_ij = a e_i . e_j / (4 |T|),
// triangle after triangle; a quad stands for the four triangles of its two diagonals, each half.
TEST(Cascade, TheOperatorIsAssembledFromTriangles) {
    for (bool isQuads : {false, true}) {
        auto scene = isQuads ? test::MakeTorus(9, 7) : LoadMesh("torustri");
        auto const refiner = test::MakeRefiner(scene, 1);
        auto const mesh = far_ext::MakeCascadeMesh(*refiner, 1);
        auto const level = far_ext::BuildCascadeLevel(mesh, {}, BoundaryRule::Fixed);
        double const sigma = 0.3, a = sigma * sigma / 2;
        eval::Cascade<double> cascade(scene.positions, {}, {.width = sigma});
        cascade.Step(level, 0);
        auto const points = cascade.GetStartPositions();
        Eigen::MatrixXd L = Eigen::MatrixXd::Zero(mesh.numVertices, mesh.numVertices);
        Eigen::VectorXd M = Eigen::VectorXd::Zero(mesh.numVertices);
        auto const at = [&](Index i) {
            return Eigen::Vector3d(points[3 * static_cast<size_t>(i)],
                                   points[3 * static_cast<size_t>(i) + 1],
                                   points[3 * static_cast<size_t>(i) + 2]);
        };
        auto const add = [&](std::array<Index, 3> const& t, double share) {
            double const area = 0.5 * (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).norm();
            auto const edge = [&](size_t i) -> Eigen::Vector3d {
                return at(t[(i + 2) % 3]) - at(t[(i + 1) % 3]);
            };
            for (size_t i = 0; i < 3; ++i) {
                M[t[i]] += share * area / 3;
                for (size_t j = 0; j < 3; ++j)
                    L(t[i], t[j]) += share * a * edge(i).dot(edge(j)) / (4 * area);
            }
        };
        for (Index face = 0; face < mesh.GetNumFaces(); ++face) {
            Index const* const f = &mesh.faces[static_cast<size_t>(face * mesh.faceSize)];
            if (isQuads) {
                for (size_t k = 0; k < 4; ++k) add({f[k], f[(k + 1) % 4], f[(k + 2) % 4]}, 0.5);
            } else {
                add({f[0], f[1], f[2]}, 1.0);
            }
        }
        auto const& op = cascade.GetOperator();
        ASSERT_EQ(level.numUnknowns, mesh.numVertices);
        for (Index row = 0; row < level.numUnknowns; ++row) {
            Index const vertex = level.vertices[row];
            EXPECT_NEAR(op.masses[row], M[vertex], 1e-12);
            EXPECT_NEAR(op.diagonals[row], M[vertex] + L(vertex, vertex), 1e-12);
            Eigen::VectorXd expected = -L.row(vertex).transpose();
            expected[vertex] = 0.0;
            for (int k = level.offsets[row]; k < level.offsets[row + 1]; ++k)
                expected[level.vertices[level.neighbours[k]]] -= op.edges[k];
            EXPECT_LT(test::LargestOf(expected), 1e-12);
        }
    }
}

// The sweep as a kernel and as a table that OpenSubdiv evaluates.
TEST(Cascade, ASweepIsItsStencilTable) {
    for (bool isQuads : {false, true}) {
        auto scene = isQuads ? test::MakeTorus(9, 7) : LoadMesh("gridholetri");
        auto const levels = QuarterLevels(scene, 2, BoundaryRule::Fixed);
        double const width = 0.2 * MeasureEdges(scene).mean;
        CascadeOptions const options{.solver = CascadeSolver::Jacobi, .width = width};
        eval::Cascade<float> cascade(scene.positions, {}, options);
        for (auto const& level : levels) cascade.Step(level, 2);
        auto const& level = levels.back();
        auto const& op = cascade.GetOperator();
        auto swept = cascade.GetRows();
        eval::SweepJacobi(level, op, cascade.GetRows(), cascade.GetStartRows(), swept);
        std::vector<float> scales;
        for (float diagonal : op.diagonals)
            scales.push_back(diagonal > 0 ? 0.75f / diagonal : 0.0f);
        far_ext::CascadeStencils table(level);
        table.SetWeights(level, op.edges, op.masses, scales);
        auto source = cascade.GetRows();
        source.insert(source.end(), cascade.GetStartRows().begin(), cascade.GetStartRows().end());
        auto evaluated = cascade.GetRows();
        OpenSubdiv::Osd::BufferDescriptor const four(0, 4, 4);
        OpenSubdiv::Osd::CpuEvaluator::EvalStencils(
            source[0].data(), four, evaluated[0].data(), four, table.GetSizes().data(),
            table.GetOffsets().data(), table.GetControlIndices().data(), table.GetWeights().data(),
            0, table.GetNumStencils());
        double const box = test::BoxDiagonal(scene.positions);
        for (size_t row = 0; row < swept.size(); ++row) {
            EXPECT_LT(test::LargestOf(swept[row] - evaluated[row]), 1e-6 * box);
        }
    }
}

// Iterations by count go on after nothing is left to gain; numbers stay numbers, and stay where
// they were.
TEST(Cascade, MoreIterationsThanThereAreUnknownsDoNoHarm) {
    auto const scene = LoadMesh("icosa");
    auto const levels = QuarterLevels(scene, 2, BoundaryRule::Fixed);
    double const width = 0.2 * MeasureEdges(scene).mean;
    auto const run = [&](CascadeOptions const& options, int iterations) {
        eval::Cascade<double> cascade(scene.positions, {}, options);
        for (auto const& level : levels) cascade.Step(level, iterations);
        return cascade.GetPositions();
    };
    auto const exact = run({.solver = CascadeSolver::Exact, .width = width}, 1);
    for (int iterations : {100, 5000, 20000})
        EXPECT_LT(test::LargestDifference(run({.width = width}, iterations), exact), 1e-12)
            << iterations;
}

// Where sigma is 0 on a triangle nothing moves, to the bit, and NaN comes from nowhere.
TEST(Cascade, WithoutWidthNothingMoves) {
    auto const scene = LoadMesh("torustri");
    std::vector<double> widths(static_cast<size_t>(scene.cage.numVertices), 0.0);
    auto const levels = QuarterLevels(scene, 2, BoundaryRule::Fixed);
    widths[0] = 0.1;
    for (auto solver :
         {CascadeSolver::Exact, CascadeSolver::ConjugateGradients, CascadeSolver::Jacobi}) {
        eval::Cascade<double> cascade(scene.positions, widths, {.solver = solver, .width = -1.0});
        for (auto const& level : levels) cascade.Step(level, 20);
        auto const points = cascade.GetPositions(), start = cascade.GetStartPositions(),
                   found = cascade.GetWidths();
        std::vector<double> nearby = found;  // the largest in the ring
        auto const& level = levels.back();
        for (Index row = 0; row < level.numUnknowns; ++row) {
            for (int k = level.offsets[row]; k < level.offsets[row + 1]; ++k) {
                double& largest = nearby[level.vertices[row]];
                largest = std::max(largest, found[level.vertices[level.neighbours[k]]]);
            }
        }
        size_t numStill = 0, numMoved = 0;
        for (size_t i = 0; i < points.size(); i += 3) {
            bool const isStill = points[i] == start[i] && points[i + 1] == start[i + 1] &&
                                 points[i + 2] == start[i + 2];
            (isStill ? numStill : numMoved) += 1;
            EXPECT_TRUE(isStill || nearby[i / 3] != 0.0) << "vertex " << i / 3;
            EXPECT_TRUE(std::isfinite(points[i] + points[i + 1] + points[i + 2]));
        }
        EXPECT_GT(numStill, points.size() / 3 * 8 / 10);
        EXPECT_GT(numMoved, 10u);
    }
}

// Far above what an icosahedron carries it collapses; the metric may freeze, numbers stay numbers.
TEST(Cascade, ACollapseStaysFinite) {
    auto const scene = LoadMesh("icosa");
    auto const levels = QuarterLevels(scene, 4, BoundaryRule::Fixed);
    eval::Cascade<double> cascade(scene.positions, {},
                                  {.tolerance = 1e-6, .width = MeasureEdges(scene).mean});
    for (auto const& level : levels) cascade.Step(level, 1000);
    for (double value : cascade.GetPositions()) EXPECT_TRUE(std::isfinite(value));
    // What is left is smaller than rounding of the start; its own shape is noise, and no metric to
    // go on with.
    for (int repeat = 0; repeat < 20; ++repeat) {
        auto const report = cascade.Repeat(1000);
        EXPECT_TRUE(report.isMetricFrozen || repeat == 0);
        EXPECT_LT(test::BoxDiagonal(cascade.GetPositions()), 1e-3);
    }
}

}  // namespace
}  // namespace limn
