// SPDX-License-Identifier: Apache-2.0
//
// Sweeps of limn smooth as matrices, and through an evaluator.

#include <gtest/gtest.h>

#include "engine/smooth/smooth.h"
#include "far_ext/rows/sparse_matrix.h"
#include "support/cascade_meshes.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using engine::Model;
using engine::SmoothOptions;

/// Eigen's matrix of sweeps, one column per coordinate.
using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

constexpr int kSweeps = 5;

engine::SmoothResult SmoothBySweeps(Model const& model, double width, int levels,
                                    SmoothOptions options = {}) {
    options.levels = levels;
    options.solver = eval::CascadeSolver::Jacobi;
    options.stop = engine::IterationsPerLevel{kSweeps};
    engine::Job job;
    return engine::Smooth(model, engine::ConstantWidth{width}, options, job);
}

/// Points of a level from those of the one before.
std::vector<double> Refine(Far::TopologyRefiner const& refiner, int level,
                           std::vector<double> const& coarse) {
    auto const mesh = far_ext::MakeCascadeMesh(refiner, level);
    return test::ApplyParents(mesh.parentOffsets, mesh.parents, coarse);
}

Columns ToColumns(std::vector<double> const& points) {
    return Eigen::Map<Columns const>(points.data(), static_cast<Eigen::Index>(points.size() / 3),
                                     3);
}

/// Closed and open, of triangles and of quads.
std::vector<engine::Scene> MakeSweptScenes() {
    return {test::MakeIcosphere(1), test::LoadMesh("gridholetri"), test::MakeTorus(9, 7),
            test::MakeGridWithHole(6, 5)};
}

TEST(Sweeps, ThePairOfALevelMakesItsVertices) {
    for (engine::Scene const& scene : MakeSweptScenes()) {
        auto const model = Model::Build(scene);
        double const diagonal = test::BoxDiagonal(scene.positions);
        double const width = 0.1 * test::MeasureEdges(scene).mean;
        int const levels = 2;
        auto const refiner = test::MakeRefiner(scene, levels);
        auto const sweeps = SmoothBySweeps(model, width, levels, {.keepsSweeps = true}).sweeps;
        ASSERT_EQ(sweeps.size(), 2u);
        std::vector<double> start = scene.positions, present = start;
        for (int level = 1; level <= levels; ++level) {
            auto const& [number, matrices] = sweeps[static_cast<size_t>(level - 1)];
            EXPECT_EQ(number, level);
            start = Refine(*refiner, level, start);
            Columns points = ToColumns(Refine(*refiner, level, present));
            Columns const first = ToColumns(start);
            auto const size = static_cast<Index>(points.rows());
            auto const sweep = far_ext::AsMatrix(matrices.sweep, size);
            auto const load = far_ext::AsMatrix(matrices.load, size);
            for (int i = 0; i < kSweeps; ++i) points = sweep * points + load * first;
            present = SmoothBySweeps(model, width, level).mesh->positions;
            EXPECT_LT((points - ToColumns(present)).cwiseAbs().maxCoeff(), 1e-12 * diagonal);
        }
        EXPECT_GT(test::LargestDifference(start, present), 5e-4 * diagonal);
    }
}

TEST(Sweeps, RowsOfAPairAddUpToOne) {
    for (engine::Scene const& scene : MakeSweptScenes()) {
        double const width = 0.1 * test::MeasureEdges(scene).mean;
        auto const result = SmoothBySweeps(Model::Build(scene), width, 2, {.keepsSweeps = true});
        for (auto const& [level, matrices] : result.sweeps) {
            int const size = matrices.sweep.GetNumRows();
            std::vector<double> const ones(static_cast<size_t>(size), 1.0);
            auto const ofSweep = matrices.sweep.Apply(ones), ofLoad = matrices.load.Apply(ones);
            for (size_t i = 0; i < ones.size(); ++i)
                EXPECT_NEAR(ofSweep[i] + ofLoad[i], 1.0, 1e-14) << level;
        }
    }
}

TEST(Sweeps, WithoutRefinementThePairIsThatOfTheMesh) {
    auto const scene = test::MakeIcosphere(1);
    auto const sweeps = SmoothBySweeps(Model::Build(scene), 0.1, 0, {.keepsSweeps = true}).sweeps;
    ASSERT_EQ(sweeps.size(), 1u);
    EXPECT_EQ(sweeps[0].level, 0);
    EXPECT_EQ(sweeps[0].matrices.sweep.GetNumRows(), scene.cage.numVertices);
}

TEST(Sweeps, AnEvaluatorIsNearTheDoubles) {
    for (engine::Scene const& scene : MakeSweptScenes()) {
        auto const model = Model::Build(scene);
        double const width = 0.1 * test::MeasureEdges(scene).mean;
        auto const expected = SmoothBySweeps(model, width, 3).mesh->positions;
        for (auto kind : {eval::EvaluatorKind::Simd, eval::EvaluatorKind::OsdCpu,
                          eval::EvaluatorKind::OsdOmp}) {
            eval::TableEvaluator door(kind);
            auto const found = SmoothBySweeps(model, width, 3, {.evaluator = &door});
            EXPECT_LT(test::LargestDifference(found.mesh->positions, expected),
                      1e-6 * test::BoxDiagonal(scene.positions));
        }
    }
}

TEST(Sweeps, AnEvaluatorCountsEverySweep) {
    eval::TableEvaluator door(eval::EvaluatorKind::OsdCpu);
    auto const result =
        SmoothBySweeps(Model::Build(test::MakeIcosphere(1)), 0.1, 2, {.evaluator = &door});
    auto const uses = door.GetUses();
    ASSERT_EQ(uses.size(), 3u);
    EXPECT_EQ(uses[0].what, "prolongation");
    EXPECT_EQ(uses[0].applications, 4u);  // of surface and start surface, on two levels
    EXPECT_EQ(uses[1].what, "sweep");
    EXPECT_EQ(uses[1].applications, 2u * kSweeps);
    EXPECT_EQ(uses[2].what, "load");
    EXPECT_EQ(uses[2].applications, 2u);
    size_t rows = 0;
    for (auto const& level : result.report.levels) rows += static_cast<size_t>(level.unknowns);
    for (auto const& use : uses) EXPECT_EQ(use.rows, rows);
}

// To the bit, though floats would have rounded it.
TEST(Sweeps, WhatNothingMovesStaysWhereItIsUnderAnEvaluator) {
    auto const scene = test::LoadMesh("gridholetri");
    auto const model = Model::Build(scene);
    eval::TableEvaluator door(eval::EvaluatorKind::Simd);
    auto const refined = SmoothBySweeps(model, 0.1, 2, {.evaluator = &door}).mesh->positions;
    auto const still = SmoothBySweeps(model, 0.0, 2, {.evaluator = &door}).mesh->positions;
    auto const refiner = test::MakeRefiner(scene, 2);
    auto const level = refiner->GetLevel(2);
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (!level.IsVertexBoundary(vertex)) continue;
        EXPECT_EQ(test::PointAt(refined, vertex), test::PointAt(still, vertex));
    }
}

TEST(Sweeps, OnlyJacobiSweeps) {
    auto const model = Model::Build(test::MakeIcosphere(0));
    eval::TableEvaluator door(eval::EvaluatorKind::Simd);
    engine::Job job;
    for (auto solver : {eval::CascadeSolver::ConjugateGradients, eval::CascadeSolver::Exact}) {
        for (SmoothOptions const& options :
             {SmoothOptions{.solver = solver, .evaluator = &door},
              SmoothOptions{.solver = solver, .keepsSweeps = true}}) {
            EXPECT_EQ(test::CodeOf(
                          [&] { engine::Smooth(model, engine::ConstantWidth{0.1}, options, job); }),
                      ErrorCode::BadOption);
        }
    }
    for (SmoothOptions const& options : {SmoothOptions{.steps = 2, .keepsSweeps = true},
                                         SmoothOptions{.settle = 1e-3, .keepsSweeps = true}}) {
        EXPECT_EQ(test::CodeOf([&] { SmoothBySweeps(model, 0.1, 1, options); }),
                  ErrorCode::BadOption);
    }
}

}  // namespace
}  // namespace limn
