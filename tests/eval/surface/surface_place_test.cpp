// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/surface_place.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "eval/surface/surface_sample.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using eval::LimitSurface;
using eval::SurfacePlace;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Quads, triangles and a pentagon under Catmull-Clark; triangles under Loop.
std::vector<engine::Scene> MakeScenes() {
    return {test::MakeCube(), test::MakeTriangleTorus(6, 5), test::MakePrism(5),
            test::MakeScene({0, 0, 0, 2, 0, 0, 2, 1, 0, 1, 2, 0, 0, 1, 0, 1, -1, 1},
                            {{0, 1, 2, 3, 4}, {1, 0, 5}})};
}

Eigen::Vector3d FindLimit(LimitSurface const& surface, engine::Scene const& scene,
                          SurfacePlace const& place) {
    eval::FaceTree tree(surface, scene.positions, 3);
    tree.Bind(place.face);
    return eval::EvaluateDerivatives(tree, place.domain, place.s, place.t).position;
}

// All faces round a vertex agree where its limit lies.
TEST(SurfacePlace, ACornerIsTheVertexsLimit) {
    for (auto const& scene : MakeScenes()) {
        auto const refiner = test::MakeRefiner(scene, 0);
        auto const level = refiner->GetLevel(0);
        LimitSurface const surface(*refiner);
        for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
            auto const faces = level.GetVertexFaces(vertex);
            auto const corners = level.GetVertexFaceLocalIndices(vertex);
            auto const first =
                FindLimit(surface, scene, eval::GetCornerPlace(surface, faces[0], corners[0]));
            for (int i = 1; i < faces.size(); ++i) {
                auto const other =
                    FindLimit(surface, scene, eval::GetCornerPlace(surface, faces[i], corners[i]));
                EXPECT_LT((first - other).norm(), 1e-12) << "vertex " << vertex;
            }
        }
    }
}

// Both faces at an edge agree, one of which goes along it the other way.
TEST(SurfacePlace, APlaceOfAnEdgeIsTheSameFromBothSides) {
    for (auto const& scene : MakeScenes()) {
        auto const refiner = test::MakeRefiner(scene, 0);
        auto const level = refiner->GetLevel(0);
        LimitSurface const surface(*refiner);
        for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
            auto const faces = level.GetEdgeFaces(edge);
            auto const corners = level.GetEdgeFaceLocalIndices(edge);
            if (faces.size() != 2) continue;
            for (double tau : {0.0, 0.25, 0.5, 0.625, 1.0}) {
                auto const limitOf = [&](int i, double along) {
                    int const size = level.GetFaceVertices(faces[i]).size();
                    return FindLimit(
                        surface, scene,
                        eval::GetEdgePlace(surface, faces[i], size, corners[i], along));
                };
                EXPECT_LT((limitOf(0, tau) - limitOf(1, 1.0 - tau)).norm(), 1e-12)
                    << "edge " << edge << " at " << tau;
            }
        }
    }
}

TEST(SurfacePlace, GaussWeightsAddUpToTheDomainsArea) {
    for (auto const& scene : MakeScenes()) {
        auto const refiner = test::MakeRefiner(scene, 0);
        LimitSurface const surface(*refiner);
        for (Index face = 0; face < surface.GetNumFaces(); ++face) {
            double sum = 0.0;
            eval::ForEachGaussPoint(surface, face, [&](SurfacePlace const& place, double weight) {
                EXPECT_EQ(place.face, face);
                sum += weight;
            });
            EXPECT_NEAR(sum, surface.GetNumDomains(face) * (surface.IsLoop() ? 0.5 : 1.0), 1e-14);
        }
    }
}

// The middle of a quad is the far corner of all its children, that of a triangle the middle of the
// flipped one.
TEST(SurfacePlace, AChildHasCoordinatesOfItsOwn) {
    double s = 0.75, t = 0.25;
    EXPECT_EQ(eval::GetChildAt(false, s, t), 1);
    EXPECT_EQ(s, 0.5);
    EXPECT_EQ(t, 0.5);
    s = t = 0.375;
    EXPECT_EQ(eval::GetChildAt(true, s, t), 3);
    EXPECT_EQ(s, 0.25);
    EXPECT_EQ(t, 0.25);
}

struct Outside {
    bool isLoop;
    double s, t;
};
class PlaceOutside : public testing::TestWithParam<Outside> {};
INSTANTIATE_TEST_SUITE_P(Places, PlaceOutside,
                         testing::Values(Outside{false, -2e-12, 0.5}, Outside{false, 0.5, -2e-12},
                                         Outside{false, 1.0 + 2e-12, 0.5},
                                         Outside{false, 0.5, 1.0 + 2e-12},
                                         Outside{true, -2e-12, 0.5}, Outside{true, 0.5, -2e-12},
                                         Outside{true, 0.5, 0.5 + 2e-12}, Outside{false, kNaN, 0.5},
                                         Outside{false, 0.5, kNaN}, Outside{true, kNaN, 0.5},
                                         Outside{true, 0.5, kNaN}, Outside{false, 5.0, 0.5},
                                         Outside{false, 0.5, -kInfinity},
                                         Outside{true, kInfinity, -kInfinity}));

TEST_P(PlaceOutside, IsRefused) {
    auto const [isLoop, s, t] = GetParam();
    EXPECT_EQ(test::CodeOf([&, isLoop = isLoop, s = s, t = t] {
                  eval::CheckInDomain(isLoop, {0, 0, s, t});
              }),
              ErrorCode::BadOption);
}

TEST_P(PlaceOutside, IsFoundWhereverItStandsInAnArray) {
    auto const [isLoop, badS, badT] = GetParam();
    for (size_t at = 0; at < 5; ++at) {
        std::vector<double> s(5, 0.25), t(5, 0.25);
        s[at] = badS;
        t[at] = badT;
        auto const refusal =
            test::RefusalOf([&, isLoop = isLoop] { eval::CheckInDomain(isLoop, 0, 0, s, t); });
        EXPECT_TRUE(refusal.starts_with(fmt::format("place {}: ", at))) << refusal;
    }
}

TEST(SurfacePlace, RoundingAtADomainsEdgeIsNoReasonToRefuse) {
    for (double slack : {-1e-12, 0.0, 1e-12}) {
        EXPECT_NO_THROW(eval::CheckInDomain(false, {0, 0, std::min(slack, 0.0), 1.0 + slack}));
        EXPECT_NO_THROW(eval::CheckInDomain(true, {0, 0, 0.5, 0.5 + 0.9 * slack}));
    }
    std::vector<double> const edges{-1e-12, -0.0, 1.0, 1.0 + 1e-12}, zeros(4, 0.0);
    EXPECT_NO_THROW(eval::CheckInDomain(false, 0, 0, edges, edges));
    EXPECT_NO_THROW(eval::CheckInDomain(true, 0, 0, edges, zeros));
}

TEST(SurfacePlace, ARefusalNamesThePlaceTheValueAndTheBound) {
    auto const refiner = test::MakeRefiner(test::MakeCube(), 0);
    LimitSurface const surface(*refiner);
    EXPECT_EQ(test::RefusalOf([&] { eval::CheckFace(surface, 77); }),
              "face 77 does not exist; the surface has 6 faces, 0 to 5");
    EXPECT_EQ(test::RefusalOf([&] { eval::CheckDomain(3, 1, 1); }),
              "domain 1 does not exist; face 3 has domains 0 to 0");
    EXPECT_EQ(test::RefusalOf([&] { eval::CheckInDomain(false, {12, 0, 1.5, -3.0}); }),
              "(1.5, -3) lies outside domain 0 of face 12");
    std::vector<double> const s{0.5, 0.5, 1.5}, t{0.5, 0.5, -3.0};
    EXPECT_EQ(test::RefusalOf([&] { eval::CheckInDomain(false, 12, 0, s, t); }),
              "place 2: (1.5, -3) lies outside domain 0 of face 12");
    std::vector<SurfacePlace> const places{{5, 0, 0.5, 0.5}, {6, 0, 0.5, 0.5}};
    EXPECT_EQ(test::RefusalOf([&] { eval::CheckPlaces(surface, places); }),
              "place 1: face 6 does not exist; the surface has 6 faces, 0 to 5");
}

TEST(SurfacePlace, ArraysOfUnequalLengthAreRefused) {
    std::vector<double> const s(5, 0.5), t(4, 0.5);
    EXPECT_EQ(test::RefusalOf([&] { eval::CheckInDomain(false, 0, 0, s, t); }),
              "places: 5 values of s and 4 of t; each has one of both");
    EXPECT_EQ(test::RefusalOf([&] { eval::CheckRoom(4, 5); }),
              "results: room for 4 is too little for 5 places");
}

// What has no limit is not evaluated; a list may name it, and gets nothing there.
TEST(SurfacePlace, AHoleIsRefusedAloneAndAllowedInAList) {
    auto scene = test::MakeCube();
    scene.cage.holes = {2};
    auto const refiner = test::MakeRefiner(scene, 0);
    LimitSurface const surface(*refiner);
    EXPECT_EQ(test::RefusalOf([&] { eval::CheckFace(surface, 2); }), "face 2 has no limit");
    std::vector<SurfacePlace> const places{{2, 0, 0.5, 0.5}};
    EXPECT_NO_THROW(eval::CheckPlaces(surface, places));
}

}  // namespace
}  // namespace limn
