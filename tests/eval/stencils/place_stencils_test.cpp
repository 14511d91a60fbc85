// SPDX-License-Identifier: Apache-2.0
#include "eval/stencils/place_stencils.h"

#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "far_ext/error.h"
#include "far_ext/topology/refiner.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/meshes.h"

namespace limn::eval {
namespace {

/// Random places of every face (of large meshes: some faces), and its corners, which may be
/// irregular.
std::vector<SurfacePlace> MakePlaces(LimitSurface const& surface) {
    std::vector<SurfacePlace> places;
    std::mt19937 random(1);
    auto const next = [&] { return static_cast<double>(random()) / 4294967296.0; };
    Index const step = std::max(1, surface.GetNumFaces() / 100);
    for (Index face = 0; face < surface.GetNumFaces(); face += step) {
        for (int domain = 0; domain < surface.GetNumDomains(face); ++domain) {
            for (int i = 0; i < 3; ++i) {
                double const s = next(), t = surface.IsLoop() ? (1.0 - s) * next() : next();
                places.push_back({face, domain, s, t});
            }
            places.push_back({face, domain, 0.0, 0.0});
            places.push_back({face, domain, 1e-3, 2e-3});
            places.push_back({face, domain, 0.0, 0.5});
        }
    }
    return places;
}

double Scale(engine::Scene const& scene) {
    double largest = 0.0;
    for (double x : scene.positions) largest = std::max(largest, std::abs(x));
    return largest;
}

TEST(PlaceStencils, AgreeWithEvaluatingEachPlaceOnEveryCage) {
    for (std::string const& shape : test::ListShapes()) {
        auto const scene = test::LoadShape(shape);
        auto const refiner = far_ext::CreateRefiner(scene.cage);
        LimitSurface const surface(*refiner);
        auto const places = MakePlaces(surface);
        PlaceStencils const stencils(surface, places);
        auto const samples = stencils.Evaluate(scene.positions, Orientation::Right);
        FaceTree tree(surface, scene.positions, 3);
        double const scale = Scale(scene);
        size_t numCompared = 0;
        for (size_t i = 0; i < places.size(); ++i) {
            if (!surface.HasLimit(places[i].face)) continue;
            ++numCompared;
            tree.Bind(places[i].face);
            auto const expected = EvaluateSample(tree, places[i].domain, places[i].s, places[i].t);
            auto const& c = samples[i].curvature;
            ASSERT_LT((samples[i].position - expected.position).norm(), 1e-13 * scale)
                << shape << i;
            ASSERT_LT((samples[i].normal - expected.normal).norm(), 1e-8) << shape << i;
            double const bend = std::max(
                {std::abs(expected.curvature.k1), std::abs(expected.curvature.k2), 1.0 / scale});
            ASSERT_LT(std::abs(c.k1 - expected.curvature.k1), 1e-6 * bend) << shape << i;
            ASSERT_LT(std::abs(c.k2 - expected.curvature.k2), 1e-6 * bend) << shape << i;
        }
        EXPECT_GT(numCompared, 0u) << shape;
    }
}

TEST(PlaceStencils, OrdinaryPlacesAgreeToTheLastDigits) {
    auto const scene = test::MakeFan(5, Sdc::SCHEME_CATMARK, 0.2, 0.1);
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    LimitSurface const surface(*refiner);
    std::vector<SurfacePlace> places;
    for (int i = 1; i < 40; ++i) places.push_back({0, 0, i / 40.0, 1.0 - i / 50.0});
    PlaceStencils const stencils(surface, places);
    EXPECT_EQ(stencils.GetNumRows(), places.size());
    auto const samples = stencils.Evaluate(scene.positions, Orientation::Right);
    FaceTree tree(surface, scene.positions, 3);
    tree.Bind(0);
    for (size_t i = 0; i < places.size(); ++i) {
        auto const expected = EvaluateSample(tree, 0, places[i].s, places[i].t);
        EXPECT_LT((samples[i].normal - expected.normal).norm(), 1e-13);
        EXPECT_NEAR(samples[i].curvature.k1, expected.curvature.k1, 1e-12);
        EXPECT_NEAR(samples[i].curvature.k2, expected.curvature.k2, 1e-12);
    }
}

TEST(PlaceStencils, FarFromTheOriginNoDigitsAreLostBesideThePositions) {
    auto scene = test::MakeFan(7, Sdc::SCHEME_LOOP, 0.2, 0.1);
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    LimitSurface const surface(*refiner);
    PlaceStencils const stencils(surface, {{0, 0, 0.25, 0.5}});
    double const k1 = stencils.Evaluate(scene.positions, Orientation::Right)[0].curvature.k1;
    for (double& x : scene.positions) x += 1024.0;
    EXPECT_NEAR(stencils.Evaluate(scene.positions, Orientation::Right)[0].curvature.k1, k1, 1e-10);
    TableEvaluator door(EvaluatorKind::Simd);
    auto const evaluator = door.Make("places", stencils.MakeRows());
    EXPECT_NEAR(stencils.Evaluate(scene.positions, Orientation::Right, evaluator)[0].curvature.k1,
                k1, 1e-4);
}

TEST(PlaceStencils, EvaluatorsInFloatAgree) {
    auto const scene = test::LoadShape("catmark_bishop");
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    LimitSurface const surface(*refiner);
    auto const places = MakePlaces(surface);
    PlaceStencils const stencils(surface, places);
    auto const expected = stencils.Evaluate(scene.positions, Orientation::Right);
    for (auto kind : {EvaluatorKind::Simd, EvaluatorKind::OsdCpu}) {
        TableEvaluator door(kind);
        auto const samples = stencils.Evaluate(scene.positions, Orientation::Right,
                                               door.Make("places", stencils.MakeRows()));
        for (size_t i = 0; i < places.size(); ++i) {
            ASSERT_LT((samples[i].position - expected[i].position).norm(), 1e-6 * Scale(scene))
                << GetName(kind) << i;
            ASSERT_LT((samples[i].normal - expected[i].normal).norm(), 1e-3) << GetName(kind) << i;
        }
    }
}

TEST(PlaceStencils, WhatFloatCannotHoldIsRefused) {
    auto scene = test::MakeCube();
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    LimitSurface const surface(*refiner);
    PlaceStencils const stencils(surface, {{0, 0, 0.5, 0.5}});
    scene.positions[3] = 1e300;
    TableEvaluator door(EvaluatorKind::Simd);
    EXPECT_THROW(stencils.Evaluate(scene.positions, Orientation::Right,
                                   door.Make("places", stencils.MakeRows())),
                 Error);
}

TEST(PlaceStencils, APlaceThatDoesNotExistIsRefusedByItsNumber) {
    auto const scene = test::MakeCube();
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    LimitSurface const surface(*refiner);
    auto const refusalOf = [&](SurfacePlace const& place) {
        return test::RefusalOf([&] { PlaceStencils(surface, {{0, 0, 0.5, 0.5}, place}); });
    };
    EXPECT_EQ(refusalOf({77, 0, 0.5, 0.5}),
              "place 1: face 77 does not exist; the surface has 6 faces, 0 to 5");
    EXPECT_EQ(refusalOf({5, 1, 0.5, 0.5}),
              "place 1: domain 1 does not exist; face 5 has domains 0 to 0");
    EXPECT_EQ(refusalOf({5, 0, 1.5, -3.0}), "place 1: (1.5, -3) lies outside domain 0 of face 5");
    EXPECT_EQ(refusalOf({5, 0, 0.5, std::nan("")}),
              "place 1: (0.5, nan) lies outside domain 0 of face 5");
}

TEST(PlaceStencils, PositionsThatAreTooShortAreRefused) {
    auto const scene = test::MakeCube();
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    LimitSurface const surface(*refiner);
    PlaceStencils const stencils(surface, {{0, 0, 0.5, 0.5}});
    TableEvaluator door(EvaluatorKind::Simd);
    auto const evaluator = door.Make("places", stencils.MakeRows());
    std::vector<double> const six(6);
    std::string const message = "positions: 6 values are too few for 8 vertices of 3";
    EXPECT_EQ(test::RefusalOf([&] { stencils.Evaluate(six, Orientation::Right); }), message);
    EXPECT_EQ(test::RefusalOf([&] { stencils.Evaluate(six, Orientation::Right, evaluator); }),
              message);
}

}  // namespace
}  // namespace limn::eval
