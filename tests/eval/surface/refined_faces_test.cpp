// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/refined_faces.h"

#include <gtest/gtest.h>

#include "eval/surface/surface_sample.h"
#include "far_ext/topology/refiner.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"

namespace limn {
namespace {

class RefinedFacesOf : public testing::TestWithParam<char const*> {};
INSTANTIATE_TEST_SUITE_P(Cages, RefinedFacesOf,
                         testing::Values("catmark_cube_creases0", "catmark_nonquads",
                                         "catmark_hole_test1", "catmark_edgenone",
                                         "catmark_edgeonly", "catmark_dart_edgecorner",
                                         "loop_cube_creases0", "loop_saddle_edgecorner",
                                         "bilinear_cube"),
                         [](auto const& mesh) { return std::string(mesh.param); });

// Two roads to one limit: a place on the cage, and where it lies on the refined cage.
TEST_P(RefinedFacesOf, TheRefinedCageHasTheSameLimitThere) {
    engine::Scene const scene = test::LoadShape(GetParam());
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    eval::LimitSurface const surface(*refiner);
    eval::FaceTree tree(surface, scene.positions, 3);
    for (int levels : {0, 1, 3}) {
        engine::Scene const fine = test::Refine(scene, levels);
        auto const fineRefiner = far_ext::CreateRefiner(fine.cage);
        eval::LimitSurface const fineSurface(*fineRefiner);
        eval::FaceTree fineTree(fineSurface, fine.positions, 3);
        eval::RefinedFaces const faces(surface, levels);
        size_t numPlaces = 0;
        for (Index face = 0; face < surface.GetNumFaces(); ++face) {
            if (!surface.HasLimit(face)) continue;
            tree.Bind(face);
            for (int domain = 0; domain < surface.GetNumDomains(face); ++domain) {
                for (auto const& [s, t] :
                     {std::pair{0.21, 0.17}, {0.06, 0.9}, {0.55, 0.3}, {0.4, 0.38}}) {
                    auto const place = faces.Find({face, domain, s, t});
                    ASSERT_LT(place.face, fineSurface.GetNumFaces());
                    ASSERT_TRUE(fineSurface.HasLimit(place.face));
                    auto const back = faces.FindBase(place);
                    EXPECT_EQ(back.face, face);
                    EXPECT_EQ(back.domain, domain);
                    EXPECT_NEAR(back.s, s, 1e-14);
                    EXPECT_NEAR(back.t, t, 1e-14);
                    fineTree.Bind(place.face);
                    for (int c = 0; c < 3; ++c) {
                        EXPECT_NEAR(
                            eval::EvaluateChannel(tree, domain, s, t, c),
                            eval::EvaluateChannel(fineTree, place.domain, place.s, place.t, c),
                            1e-9)
                            << "face " << face << " domain " << domain << " level " << levels;
                    }
                    ++numPlaces;
                }
            }
        }
        EXPECT_GT(numPlaces, 0u);
    }
}

TEST(RefinedFaces, WhatIsOutOfRangeIsRefused) {
    auto scene = test::MakePrism(5);  // pentagons below and above
    scene.cage.holes = {2};
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    eval::RefinedFaces const faces(eval::LimitSurface(*refiner), 2);
    std::vector<eval::RefinedFaces::Sample> samples;
    std::vector<double> const s{0.5, 1.5}, t{0.5, -3.0};
    EXPECT_EQ(test::RefusalOf([&] { faces.Find({77, 0, 0.5, 0.5}); }),
              "face 77 does not exist; the surface has 7 faces, 0 to 6");
    EXPECT_EQ(test::RefusalOf([&] { faces.Find({2, 0, 0.5, 0.5}); }), "face 2 has no limit");
    EXPECT_EQ(test::RefusalOf([&] { faces.FindSorted(1, 5, s, t, samples); }),
              "domain 5 does not exist; face 1 has domains 0 to 4");
    EXPECT_EQ(test::RefusalOf([&] { faces.Find({1, 2, 1.5, -3.0}); }),
              "(1.5, -3) lies outside domain 2 of face 1");
    EXPECT_EQ(test::RefusalOf([&] { faces.FindSorted(1, 2, s, t, samples); }),
              "place 1: (1.5, -3) lies outside domain 2 of face 1");
    EXPECT_EQ(test::RefusalOf([&] { faces.FindSorted(1, 2, s, std::span(t).first(1), samples); }),
              "places: 2 values of s and 1 of t; each has one of both");
}

}  // namespace
}  // namespace limn
