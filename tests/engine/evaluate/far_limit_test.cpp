// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/far_limit.h"

#include <gtest/gtest.h>

#include "support/fit_meshes.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using engine::FarComparison;
using engine::FarLimitRule;
using engine::FarReport;
using engine::Model;
using engine::PlaceList;

/// Vertices, face centres and a place near each face's first corner.
PlaceList ListPlaces(Model const& model) {
    PlaceList places;
    engine::AddVertexPlaces(model, places);
    engine::AddFaceCentres(model, places);
    for (Index face = 0; face < model.GetCage().GetNumFaces(); ++face) {
        places.faces.push_back(face);
        places.s.push_back(0.1);
        places.t.push_back(0.15);
    }
    return places;
}

FarReport Compare(engine::Scene const& scene, FarLimitRule const& rule) {
    Model const model = Model::Build(scene);
    engine::Job job;
    return engine::CompareFarLimit(model, ListPlaces(model), rule, Orientation::Right, job);
}

TEST(FarLimit, IsTheLimitOfARegularSurface) {
    for (auto const& scene : {test::MakeTorus(9, 7), test::MakeTriangleTorus(9, 7)}) {
        auto const report = Compare(scene, {.options = {.level = 2}});
        EXPECT_EQ(report.comparison.numPlaces, report.places.faces.size());
        EXPECT_LT(report.comparison.position.max, 1e-6);
        EXPECT_LT(report.comparison.normalDegrees.max, 1e-3);
        EXPECT_LT(report.comparison.meanCurvature.max, 1e-2);
    }
}

TEST(FarLimit, ComesNearerToTheLimitWithEveryLevelButNotInCurvatureAtExtraordinaryVertices) {
    auto const scene = test::LoadSpot();
    FarComparison const two = Compare(scene, {.options = {.level = 2}}).comparison;
    FarComparison const six = Compare(scene, {.options = {.level = 6}}).comparison;
    EXPECT_GT(two.position.max, 1e-5);
    EXPECT_LT(six.position.max, 1e-6);
    EXPECT_LT(six.normalDegrees.max, two.normalDegrees.max / 4);
    EXPECT_GT(six.meanCurvature.max, 1.0);
}

TEST(FarLimit, IsOneWhateverAppliesTheTable) {
    auto const scene = test::LoadSpot();
    auto const reference = Compare(scene, {}).far.values.positions;
    for (auto const kind : {eval::EvaluatorKind::Simd, eval::EvaluatorKind::OsdOmp}) {
        auto const found = Compare(scene, {.evaluator = kind}).far.values.positions;
        ASSERT_EQ(found.size(), reference.size());
        for (size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], reference[i], 2e-6);
    }
}

TEST(FarLimit, LosesNothingFarFromTheOrigin) {
    auto scene = test::LoadSpot();
    double const near = Compare(scene, {}).comparison.position.max;
    for (double& x : scene.positions) x += 0x1p20;
    EXPECT_LT(Compare(scene, {}).comparison.position.max, 2.0 * near);
}

TEST(FarLimit, PlacesOfVerticesAreTheirCornersAndThoseOfHolesAreLeftOut) {
    auto scene = test::MakeGridWithHole(4, 4);
    scene.cage.holes = {0};  // its first vertex has no other face
    Model const model = Model::Build(scene);
    PlaceList places;
    auto const vertices = engine::AddVertexPlaces(model, places);
    ASSERT_EQ(vertices.size(), places.faces.size());
    engine::Job job;
    auto const values = engine::EvaluateLimit(model, places.GetPlaces(), Orientation::Right, job);
    EXPECT_EQ(values.CountWithoutLimit(), 0u);
    size_t numReached = 0;
    for (Index vertex = 0; vertex < scene.cage.numVertices; ++vertex) {
        auto const faces = model.GetLevel().GetVertexFaces(vertex);
        bool hasFace = false;
        for (Index face : faces) hasFace |= face != 0;
        numReached += hasFace;
    }
    EXPECT_EQ(vertices.size(), numReached);
    EXPECT_LT(vertices.size(), static_cast<size_t>(scene.cage.numVertices));
}

}  // namespace
}  // namespace limn
