// SPDX-License-Identifier: Apache-2.0
//
// Refinement by tables that an evaluator applies.

#include <gtest/gtest.h>

#include "engine/scene/refine.h"
#include "eval/stencils/table_evaluator.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using engine::RefineOptions;
using eval::EvaluatorKind;

constexpr EvaluatorKind kKinds[] = {EvaluatorKind::Simd, EvaluatorKind::OsdCpu,
                                    EvaluatorKind::OsdOmp};

engine::Scene RefineBy(engine::Scene const& scene, RefineOptions options,
                       eval::TableEvaluator* evaluator) {
    options.evaluator = evaluator;
    engine::Job job;
    return engine::RefineUniformly(engine::Model::Build(scene), options, job);
}

/// Far from the origin, where floats would lose digits.
void ExpectNearTheDoubles(engine::Scene scene, RefineOptions const& options) {
    double const diagonal = test::BoxDiagonal(scene.positions);
    for (double& x : scene.positions) x += 100.0 * diagonal;
    auto const expected = RefineBy(scene, options, nullptr);
    for (auto kind : kKinds) {
        eval::TableEvaluator door(kind);
        auto const found = RefineBy(scene, options, &door);
        EXPECT_LT(test::LargestDifference(found.positions, expected.positions), 2e-6 * diagonal);
        if (expected.uvs.empty()) continue;
        EXPECT_LT(test::LargestDifference(found.uvs, expected.uvs), 2e-6);
    }
}

TEST(RefineEvaluator, PositionsAndTextureCoordinatesAreNearTheDoubles) {
    ExpectNearTheDoubles(test::LoadSpot(), {.levels = 2});
    for (char const* name : {"catmark_bishop", "catmark_nonquads", "catmark_cubes_semisharp",
                             "catmark_hole_test1", "loop_saddle_edgecorner"}) {
        SCOPED_TRACE(name);
        ExpectNearTheDoubles(test::LoadShape(name), {.levels = 3});
    }
}

TEST(RefineEvaluator, LimitsAreNearTheDoubles) {
    for (char const* name :
         {"catmark_bishop", "catmark_nonquads", "catmark_cubes_semisharp", "catmark_hole_test1",
          "catmark_dart_edgeonly", "loop_saddle_edgecorner"}) {
        SCOPED_TRACE(name);
        ExpectNearTheDoubles(test::LoadShape(name), {.levels = 1, .toLimit = true});
    }
}

TEST(RefineEvaluator, InterpolatingRulesAreNearTheDoubles) {
    auto const sphere = test::MakeQuadSphere(1);
    for (auto rule : {far_ext::SubdivisionRule::Kobbelt, far_ext::SubdivisionRule::Interpolating})
        ExpectNearTheDoubles(sphere, {.levels = 2, .rule = rule});
    ExpectNearTheDoubles(test::MakeIcosphere(1),
                         {.levels = 2, .rule = far_ext::SubdivisionRule::Butterfly});
}

TEST(RefineEvaluator, PrimvarsShareTheTablesOfPositions) {
    engine::Scene scene = test::LoadSpot();
    scene.primvars = {{"a", 2, {}}};
    for (Index vertex = 0; vertex < scene.cage.numVertices; ++vertex)
        scene.primvars[0].values.insert(scene.primvars[0].values.end(),
                                        {static_cast<float>(vertex), 1.0f});
    eval::TableEvaluator door(EvaluatorKind::OsdCpu);
    auto const found = RefineBy(scene, {.levels = 2, .toLimit = true}, &door);
    auto const expected = RefineBy(scene, {.levels = 2}, nullptr);
    auto const& values = found.primvars[0].values;
    for (size_t i = 0; i < values.size(); ++i)
        EXPECT_NEAR(values[i], expected.primvars[0].values[i], 1e-6 * scene.cage.numVertices);

    auto const uses = door.GetUses();
    ASSERT_EQ(uses.size(), 3u);
    EXPECT_EQ(uses[0].what, "S0 face-varying");
    EXPECT_EQ(uses[0].applications, 2u);
    EXPECT_EQ(uses[1].what, "S0");
    EXPECT_EQ(uses[1].applications, 6u);  // on two levels two channels and the positions
    EXPECT_EQ(uses[2].what, "A");
    EXPECT_EQ(uses[2].rows, found.positions.size() / 3);
}

}  // namespace
}  // namespace limn
