// SPDX-License-Identifier: Apache-2.0
//
// Generalised Catmull-Clark in every step, as engine::RefineUniformly takes it.

#include "eval/fit/alpha_steps.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/scene/refine.h"
#include "far_ext/limit/limit_matrix.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using engine::Model;
using engine::RefineOptions;
using test::Rows;
using test::ToRows;
using AlphaRule = far_ext::LimitOptions::AlphaRule;

engine::Scene Refine(engine::Scene const& scene, RefineOptions const& options) {
    engine::Job job;
    return engine::RefineUniformly(Model::Build(scene), options, job);
}

/// The first rows: those of the base level's vertices.
Rows FirstOf(engine::Scene const& fine, engine::Scene const& base) {
    return ToRows(fine.positions).topRows(base.cage.numVertices);
}

Rows LimitsOf(engine::Scene const& scene, double alpha) {
    auto const A = far_ext::LimitMatrix::Build(
        Model::Build(scene).GetRefiner(), 0, {.alpha = alpha, .alphaRule = AlphaRule::Stationary});
    return A.AsMatrix() * ToRows(scene.positions);
}

std::vector<engine::Scene> MakeScenes() {
    std::vector<engine::Scene> scenes{test::MakeCube(),
                                      test::MakePrism(5),
                                      test::MakeTorus(9, 7),
                                      test::MakeGridWithHole(5, 5),
                                      test::LoadShape("catmark_nonquads"),
                                      test::LoadShape("catmark_cubes_semisharp"),
                                      test::LoadShape("catmark_dart_edgeonly")};
    for (engine::Scene& scene : scenes) test::AddNoise(scene, 0.1, 7);
    return scenes;
}

// Two roads to A M: the closed form on the base level, and some steps before that of a finer one.
// Creases that fade within these steps are among them.
TEST(AlphaSteps, KeepTheLimitOfEveryVertex) {
    for (engine::Scene const& scene : MakeScenes()) {
        double const size = test::BoxDiagonal(scene.positions);
        for (double alpha : {0.25, 1.0}) {
            Rows const limits = LimitsOf(scene, alpha);
            for (int levels : {0, 1, 3}) {
                auto const fine =
                    Refine(scene, {.levels = levels, .toLimit = true, .alpha = alpha});
                EXPECT_LT(test::LargestOf(FirstOf(fine, scene) - limits), 1e-12 * size)
                    << scene.path << " " << alpha << " " << levels;
            }
        }
    }
}

// After six steps vertices are where A says, as near as the scheme converges; the matrix of alpha
// in the first step has another limit.
TEST(AlphaSteps, LeadToTheLimitsOfTheirOwnMatrix) {
    engine::Scene scene = test::MakeCube();
    test::AddNoise(scene, 0.1, 3);
    double const size = test::BoxDiagonal(scene.positions);
    double const alphas[] = {0.25, 0.5, 1.0}, bounds[] = {4e-5, 2e-4, 2e-3};
    for (int i : {0, 1, 2}) {
        Rows const after = FirstOf(Refine(scene, {.levels = 6, .alpha = alphas[i]}), scene);
        EXPECT_LT(test::LargestOf(after - LimitsOf(scene, alphas[i])), bounds[i] * size);
        Rows const first =
            far_ext::LimitMatrix::Build(Model::Build(scene).GetRefiner(), 0, {.alpha = alphas[i]})
                .AsMatrix() *
            ToRows(scene.positions);
        EXPECT_GT(test::LargestOf(after - first), 3.0 * bounds[i] * size);
    }
}

TEST(AlphaSteps, WithoutAlphaAreThePlainScheme) {
    for (engine::Scene const& scene : MakeScenes()) {
        EXPECT_EQ(Refine(scene, {.levels = 2, .alpha = 0.0}).positions,
                  Refine(scene, {.levels = 2}).positions);
    }
}

// What is subdivided along with positions has their rule: coordinates as a primvar stay those.
TEST(AlphaSteps, TakePrimvarsAlong) {
    engine::Scene scene = test::MakeTorus(9, 7);
    test::AddNoise(scene, 0.2, 7);
    scene.primvars = {{"color", 3, {scene.positions.begin(), scene.positions.end()}}};
    auto const fine = Refine(scene, {.levels = 2, .alpha = 0.5});
    for (size_t i = 0; i < fine.positions.size(); ++i)
        ASSERT_NEAR(fine.primvars[0].values[i], fine.positions[i], 1e-6);
}

TEST(AlphaSteps, RefuseOtherSchemesAndRules) {
    engine::Scene loop = test::MakeIcosphere(0);
    loop.cage.scheme = Sdc::SCHEME_LOOP;
    using far_ext::SubdivisionRule;
    EXPECT_EQ(test::CodeOf([&] { Refine(loop, {.alpha = 0.5}); }), ErrorCode::BadOption);
    EXPECT_EQ(
        test::CodeOf([&] { Refine(loop, {.rule = SubdivisionRule::Butterfly, .alpha = 0.5}); }),
        ErrorCode::BadOption);
    EXPECT_EQ(test::CodeOf([&] { Refine(test::MakeCube(), {.alpha = 1.5}); }),
              ErrorCode::BadOption);
}

}  // namespace
}  // namespace limn
