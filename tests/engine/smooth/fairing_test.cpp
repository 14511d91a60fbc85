// SPDX-License-Identifier: Apache-2.0
//
// Smooth without refinement, in several steps, and until it settles.

#include <cmath>

#include <gtest/gtest.h>

#include "engine/io/mesh_reader.h"
#include "engine/smooth/critical_factor.h"
#include "engine/smooth/smooth.h"
#include "support/cascade_meshes.h"
#include "support/dense_filter.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/listener.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using engine::ConstantWidth;
using engine::Job;
using engine::Model;
using engine::SmoothOptions;

engine::SmoothResult SmoothScene(engine::Scene const& scene, engine::FilterWidths const& widths,
                                 SmoothOptions const& options) {
    Job job;
    return engine::Smooth(Model::Build(scene), widths, options, job);
}

std::vector<double> Fair(engine::Scene const& scene, double width, SmoothOptions options = {}) {
    options.levels = 0;
    return SmoothScene(scene, ConstantWidth{width}, options).mesh.value().positions;
}

SmoothOptions const kExact{.levels = 0, .solver = eval::CascadeSolver::Exact};

std::vector<char> FindBoundary(engine::Scene const& scene) {
    auto const model = Model::Build(scene);
    std::vector<char> isBoundary;
    for (Index vertex = 0; vertex < scene.cage.numVertices; ++vertex)
        isBoundary.push_back(model.GetLevel().IsVertexBoundary(vertex));
    return isBoundary;
}

// (M + sigma^2/2 L) X = M X0, the matrices of the start mesh; boundary vertices stay.
TEST(Fairing, IsOneSolveWithTheMetricOfTheStartMesh) {
    auto const grid = test::LoadMesh("gridholetri"), icosa = test::LoadMesh("icosa");
    for (auto const& scene : {grid, icosa}) {
        double const width = 0.2 * test::MeasureEdges(scene).mean;
        test::DenseFilter const dense(scene.cage.faceVertices, scene.positions);
        test::Rows const X0 = test::ToRows(scene.positions);
        Eigen::MatrixXd const X = test::SolveWithFixed(dense.M + width * width / 2 * dense.L,
                                                       dense.M * X0, X0, FindBoundary(scene));
        auto const found = Fair(scene, width, kExact);
        EXPECT_LT(test::LargestOf(test::ToRows(found) - X),
                  1e-13 * test::BoxDiagonal(scene.positions));
    }
}

// A quad stands for the triangles of both of its diagonals, half each: the mean of both matrices.
TEST(Fairing, AQuadIsTheMeanOfItsDiagonals) {
    auto const scene = test::MakeQuadSphere(1);
    std::vector<Index> first, second;
    for (size_t face = 0; face < scene.cage.faceVertices.size(); face += 4) {
        Index const* const f = &scene.cage.faceVertices[face];
        first.insert(first.end(), {f[0], f[1], f[2], f[0], f[2], f[3]});
        second.insert(second.end(), {f[1], f[2], f[3], f[1], f[3], f[0]});
    }
    test::DenseFilter const a(first, scene.positions), b(second, scene.positions);
    Eigen::MatrixXd const M = (a.M + b.M) / 2, L = (a.L + b.L) / 2;
    Eigen::MatrixXd const X =
        (M + 0.3 * 0.3 / 2 * L).partialPivLu().solve(M * test::ToRows(scene.positions));
    EXPECT_LT(test::LargestOf(test::ToRows(Fair(scene, 0.3, kExact)) - X), 1e-13);
}

TEST(Fairing, KeepsTopologyTexturesAndTheOrderOfVertices) {
    auto const scene = engine::ReadMesh(test::ScenePath("cube/cube.obj"));
    auto const found = SmoothScene(scene, ConstantWidth{0.0}, {.levels = 0}).mesh.value();
    EXPECT_EQ(found.cage.faceVertices, scene.cage.faceVertices);
    EXPECT_EQ(found.cage.faceSizes, scene.cage.faceSizes);
    EXPECT_EQ(found.cage.fvarChannels[0].valueIndices, scene.cage.fvarChannels[0].valueIndices);
    EXPECT_EQ(found.uvs, scene.uvs);
    EXPECT_EQ(found.positions, scene.positions);
}

TEST(Fairing, NeedsTrianglesOrQuads) {
    auto const mixed = test::MakeScene({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0},
                                       {{0, 1, 2, 3}, {1, 4, 2}}, Sdc::SCHEME_CATMARK);
    auto const error = test::CatchError([&] { Fair(mixed, 0.1); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->GetCode(), ErrorCode::BadMesh);
    EXPECT_NE(std::string(error->what()).find("face 1 has 3 corners, face 0 4"), std::string::npos)
        << error->what();
}

// On a sphere of radius r the Laplacian of x is -2 x / r^2, so that a step of variance sigma^2 / N
// with the metric of the step before takes r to r / (1 + sigma^2 / (N r^2)).
TEST(Fairing, ASphereShrinksByItsLawInEachStep) {
    auto const scene = test::MakeIcosphere(4);
    double const width = 0.4;
    for (int steps : {1, 2, 5}) {
        double radius = 1.0;
        for (int step = 0; step < steps; ++step)
            radius /= 1.0 + width * width / (steps * radius * radius);
        EXPECT_NEAR(test::MeanRadius(Fair(scene, width, {.steps = steps})), radius, 1e-5) << steps;
    }
}

// With the metric of the result, r + sigma^2 / r = r0.
TEST(Fairing, ASphereSettlesAtItsFixedPoint) {
    double const width = 0.4, radius = (1.0 + std::sqrt(1.0 - 4.0 * width * width)) / 2.0;
    auto const found =
        SmoothScene(test::MakeIcosphere(3), ConstantWidth{width},
                    {.levels = 0, .settle = 1e-5, .solver = eval::CascadeSolver::Exact});
    EXPECT_NEAR(test::MeanRadius(found.mesh.value().positions), radius, 2e-3);
    auto const& moves = found.report.settleMoves;
    ASSERT_GT(moves.size(), 2u);
    EXPECT_LT(moves.back(), 1e-5);
    for (size_t k = 1; k < moves.size(); ++k) {
        EXPECT_LT(moves[k], moves[k - 1]);
        EXPECT_GE(moves[k - 1], 1e-5);
    }
}

// Settled: the surface solves the equation of its own metric, on the finest mesh of the cascade.
TEST(Fairing, WhatHasSettledSolvesTheEquationOfItsOwnMetric) {
    auto const scene = test::LoadMesh("icosa");
    SmoothOptions options{.levels = 2, .solver = eval::CascadeSolver::Exact};
    auto const start = SmoothScene(scene, ConstantWidth{0.0}, options).mesh.value();
    auto const residual = [&](std::optional<double> settle) {
        options.settle = settle;
        auto const found = SmoothScene(scene, ConstantWidth{0.5}, options).mesh.value();
        test::DenseFilter const dense(found.cage.faceVertices, found.positions);
        return test::LargestOf((dense.M + 0.5 * 0.5 / 2 * dense.L) * test::ToRows(found.positions) -
                               dense.M * test::ToRows(start.positions));
    };
    EXPECT_LT(residual(1e-7), 1e-6);
    EXPECT_GT(residual(std::nullopt), 1e-3);
}

TEST(Fairing, AFilterThatDoesNotSettleIsWarnedOf) {
    test::Listener host;
    Job job(host.MakeHost());
    auto const found =
        engine::Smooth(Model::Build(test::MakeIcosphere(2)), ConstantWidth{0.47},
                       {.levels = 0, .settle = 1e-12, .solver = eval::CascadeSolver::Exact}, job);
    EXPECT_EQ(found.report.settleMoves.size(), 30u);
    ASSERT_EQ(host.warnings.size(), 1u);
    EXPECT_NE(host.warnings[0].find("after 30 more solves"), std::string::npos) << host.warnings[0];
}

// The cascade is the first step, of sigma / sqrt 2; the second filters its result as it is.
TEST(Fairing, LaterStepsRunOnTheFinestMesh) {
    auto const scene = test::LoadMesh("icosa");
    double const width = 0.3;
    SmoothOptions const once{.levels = 2, .solver = eval::CascadeSolver::Exact};
    auto const first = SmoothScene(scene, ConstantWidth{width / std::sqrt(2.0)}, once).mesh.value();
    auto twice = once;
    twice.steps = 2;
    auto const both = SmoothScene(scene, ConstantWidth{width}, twice);
    EXPECT_LT(test::LargestDifference(Fair(first, width / std::sqrt(2.0), kExact),
                                      both.mesh.value().positions),
              1e-13);
    ASSERT_EQ(both.report.levels.size(), 3u);
    EXPECT_EQ(both.report.levels[2].level, 2);
    EXPECT_EQ(both.report.levels[2].step, 2);
    EXPECT_EQ(both.report.largestWidth, width);
    for (float value : both.mesh->primvars[0].values) EXPECT_FLOAT_EQ(value, 0.3f);
}

TEST(Fairing, ComponentsDoNotFeelEachOther) {
    auto const a = test::MakeIcosphere(2), b = test::LoadMesh("gridholetri");
    SmoothOptions const options{.levels = 0, .steps = 3, .solver = eval::CascadeSolver::Exact};
    auto const both = SmoothScene(test::Join({a, b}), ConstantWidth{0.2}, options).mesh->positions;
    std::vector<double> apart = SmoothScene(a, ConstantWidth{0.2}, options).mesh->positions;
    auto const other = SmoothScene(b, ConstantWidth{0.2}, options).mesh->positions;
    apart.insert(apart.end(), other.begin(), other.end());
    EXPECT_LT(test::LargestDifference(both, apart, true), 1e-12 * test::BoxDiagonal(both));
}

TEST(Fairing, DoesNotDependOnWhereAMeshLies) {
    auto scene = test::MakeIcosphere(2);
    SmoothOptions const options{.steps = 2, .settle = 1e-4};
    auto const near = Fair(scene, 0.3, options);
    Eigen::Vector3d const shift(1e7, -3e7, 2e7);
    Eigen::Matrix3d const same = Eigen::Matrix3d::Identity();
    scene.positions = test::Transform(scene.positions, same, shift);
    // Positions out there have steps of 4e-9.
    EXPECT_LT(
        test::LargestDifference(test::Transform(Fair(scene, 0.3, options), same, -shift), near),
        1e-7);
}

// A single solve exists for all widths: r / (1 + sigma^2 / r^2) of sigma = 2 r is a fifth.
TEST(Fairing, WithoutRepetitionNothingCollapses) {
    auto const wide = SmoothScene(test::MakeIcosphere(3), ConstantWidth{2.0}, {.levels = 0});
    ASSERT_TRUE(wide.mesh);
    EXPECT_FALSE(wide.report.hasCollapsed);
    EXPECT_NEAR(wide.report.shrinkage.value().radiusRatio, 0.2, 1e-3);
    auto const settled =
        SmoothScene(test::MakeIcosphere(3), ConstantWidth{2.0}, {.levels = 0, .settle = 1e-5});
    EXPECT_FALSE(settled.mesh);
    EXPECT_TRUE(settled.report.hasCollapsed);
}

TEST(Fairing, KeepsVolumesInAllSteps) {
    auto const scene = test::MakeIcosphere(2);
    auto const found = SmoothScene(
        scene, ConstantWidth{0.3},
        {.levels = 0, .steps = 3, .settle = 1e-3, .constraint = engine::SmoothConstraint::Volume});
    ASSERT_EQ(found.report.volumes.size(), 1u);
    EXPECT_TRUE(found.report.volumes[0].isMet);
    EXPECT_NEAR(found.report.volumes[0].end / found.report.volumes[0].start, 1.0, 1e-9);
}

// r0 / 2 of a sphere, measured to half a percent on a grid; an icosphere's is nearly that.
TEST(Fairing, TheCriticalWidthOfASphereIsHalfItsRadius) {
    Job job;
    auto const model = Model::Build(test::MakeIcosphere(2));
    EXPECT_NEAR(engine::MeasureCriticalWidth(model, job).value(), 0.5, 0.02);
    auto const open = Model::Build(test::LoadMesh("gridholetri"));
    EXPECT_FALSE(engine::MeasureCriticalWidth(open, job));
}

}  // namespace
}  // namespace limn
