// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/place_match.h"

#include <random>

#include <gtest/gtest.h>

#include "eval/forms/field_surface.h"
#include "eval/surface/surface_sample.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using Values = std::vector<double>;
using PlaceList = std::vector<eval::WantedAtPlace>;

constexpr int kPlaceLevels = 2;

Values MakeRandomForm(engine::Scene const& scene) {
    auto const refiner = test::MakeRefiner(scene, 0);
    std::mt19937 random(7);
    Values form;
    for (Index edge = 0; edge < refiner->GetLevel(0).GetNumEdges(); ++edge)
        form.push_back(static_cast<double>(random() % 2001) / 1000.0 - 1.0);
    return form;
}

/// The form's limit field in the middles of all faces refined twice, each times a factor.
template <class Factor>
PlaceList SampleField(engine::Scene const& scene, Values const& form, Factor factor) {
    auto const refiner = test::MakeRefiner(scene, 0);
    eval::LimitSurface const surface(*refiner);
    eval::RefinedFaces const refined(surface, kPlaceLevels);
    eval::FieldSurface const field(scene.cage, scene.positions, form, kPlaceLevels);
    eval::FieldSurface::Sampler sampler(field);
    double const middle = surface.IsLoop() ? 1.0 / 3.0 : 0.5;
    PlaceList wanted;
    for (Index face = 0; face < field.GetRefinedCage().GetNumFaces(); ++face) {
        sampler.Bind(face);
        auto const here = sampler.EvaluateHere(middle, middle);
        double const cell = surface.IsLoop() ? 0.5 : 1.0;
        wanted.push_back({refined.FindBase({face, 0, middle, middle}),
                          factor(sampler.IsRegular()) * here.vector,
                          cell * here.ds.cross(here.dt).norm()});
    }
    return wanted;
}

Values MatchAtPlaces(engine::Scene const& scene, PlaceList const& wanted) {
    auto const refiner = test::MakeRefiner(scene, 0);
    return eval::MatchPlaces(scene.cage, eval::LimitSurface(*refiner), scene.positions, wanted,
                             kPlaceLevels);
}

double FindRelativeError(Values const& found, Values const& expected) {
    Eigen::Map<Eigen::VectorXd const> const a(found.data(),
                                              static_cast<Eigen::Index>(found.size())),
        b(expected.data(), static_cast<Eigen::Index>(expected.size()));
    return (a - b).norm() / b.norm();
}

/// Of quads, triangles and polygons, closed and open, regular and not.
std::vector<engine::Scene> MakePlaceMeshes() {
    return {test::LoadSpot(),
            test::MakeQuadSphere(1),
            test::MakeTorus(9, 7),
            test::MakeIcosphere(1),
            test::MakeGridWithHole(7, 5),
            test::MakeDodecahedron(),
            test::MakeIrregularTriangles(9, 8, 2)};
}

// No smoothness helps here: values of a random form turn in every face.
TEST(PlaceMatch, AnyFormComesBackFromItsLimitField) {
    for (engine::Scene const& scene : MakePlaceMeshes()) {
        Values const form = MakeRandomForm(scene);
        PlaceList const wanted = SampleField(scene, form, [](bool) { return 1.0; });
        EXPECT_LT(FindRelativeError(MatchAtPlaces(scene, wanted), form), 1e-7) << scene.name;
    }
}

TEST(PlaceMatch, PlacesInIrregularFacesSayNothing) {
    engine::Scene const scene = test::LoadSpot();
    Values const form = MakeRandomForm(scene);
    auto const right = [](bool) { return 1.0; };
    auto const wrongNearCorners = [](bool isRegular) { return isRegular ? 1.0 : 100.0; };
    EXPECT_EQ(MatchAtPlaces(scene, SampleField(scene, form, wrongNearCorners)),
              MatchAtPlaces(scene, SampleField(scene, form, right)));
}

// What a vector has across the surface no tangent field has.
TEST(PlaceMatch, PartsAcrossTheSurfaceDoNotCount) {
    engine::Scene const scene = test::MakeTorus(9, 7);
    auto const refiner = test::MakeRefiner(scene, 0);
    eval::LimitSurface const surface(*refiner);
    eval::FaceTree tree(surface, scene.positions, 3);
    Values const form = MakeRandomForm(scene);
    PlaceList wanted = SampleField(scene, form, [](bool) { return 1.0; });
    for (auto& [at, vector, area] : wanted) {
        tree.Bind(at.face);
        vector += 3.0 * eval::EvaluateSample(tree, at.domain, at.s, at.t).normal;
    }
    EXPECT_LT(FindRelativeError(MatchAtPlaces(scene, wanted), form), 1e-7);
}

// A gradient has no curl: where there are no places it goes on without.
TEST(PlaceMatch, WhatPlacesLeaveOpenIsFilledInWithLittleCurl) {
    engine::Scene const scene = test::MakeQuadSphere(2);
    auto const refiner = test::MakeRefiner(scene, 0);
    Values const form = test::MakeCoordinateForm(refiner->GetLevel(0), scene.positions, 2);
    PlaceList wanted = SampleField(scene, form, [](bool) { return 1.0; });
    std::erase_if(wanted, [](auto const& place) { return place.at.face % 20 == 0; });
    EXPECT_LT(FindRelativeError(MatchAtPlaces(scene, wanted), form), 0.02);
}

}  // namespace
}  // namespace limn
