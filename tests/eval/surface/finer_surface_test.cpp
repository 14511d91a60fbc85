// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/finer_surface.h"

#include <gtest/gtest.h>

#include "eval/surface/surface_sample.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using eval::FinerSurface;

/// A cage, the cage refined, and the latter's limit.
struct FinerSubject {
    engine::Scene scene, fine;
    std::unique_ptr<Far::TopologyRefiner> refiner;
    eval::LimitSurface surface;
    std::optional<FinerSurface> finer;

    FinerSubject(engine::Scene made, int levels)
        : scene(std::move(made)),
          fine(test::Refine(scene, levels)),
          refiner(far_ext::CreateRefiner(scene.cage)),
          surface(*refiner),
          finer(FinerSurface::Build(surface, scene.cage, fine.cage, fine.positions)) {}
};

// Refined and left as it is, the mesh has the cage's limit.
TEST(FinerSurface, OfARefinedCageIsItsLimit) {
    for (auto const& scene :
         {test::MakeCube(), test::MakeFan(5, Sdc::SCHEME_LOOP, 0.2, 0.1), test::MakePrism(5)}) {
        FinerSubject const subject(scene, 2);
        ASSERT_TRUE(subject.finer);
        FinerSurface::Sampler sampler(*subject.finer);
        eval::FaceTree tree(subject.surface, scene.positions, 3);
        tree.Bind(1);
        std::vector<double> const s{0.0, 0.1, 0.5, 0.625}, t{1.0, 0.2, 0.5, 0.125};
        std::vector<Eigen::Vector3d> points(s.size());
        sampler.Evaluate(1, 0, s, t, points);
        for (size_t i = 0; i < s.size(); ++i) {
            EXPECT_LT((points[i] - eval::EvaluateDerivatives(tree, 0, s[i], t[i]).position).norm(),
                      1e-13);
        }
    }
}

// What a place lies outside of its domain doubles with each level.
TEST(FinerSurface, SlackAtABorderIsAllowedOnEveryLevel) {
    FinerSubject const subject(test::MakeCube(), 4);
    FinerSurface::Sampler sampler(*subject.finer);
    std::vector<double> const s{-1e-12, 1.0 + 1e-12}, t{0.5, 0.5};
    std::vector<Eigen::Vector3d> points(2);
    EXPECT_NO_THROW(sampler.Evaluate(0, 0, s, t, points));
}

TEST(FinerSurface, OtherFacesMakeNone) {
    FinerSubject const subject(test::MakeCube(), 1);
    auto const torus = test::MakeTorus(5, 4);
    EXPECT_FALSE(
        FinerSurface::Build(subject.surface, subject.scene.cage, torus.cage, torus.positions));
}

TEST(FinerSurface, WhatIsOutOfRangeIsRefused) {
    FinerSubject const subject(test::MakeCube(), 1);
    EXPECT_EQ(test::RefusalOf([&] {
                  FinerSurface::Build(subject.surface, subject.scene.cage, subject.fine.cage,
                                      subject.scene.positions);
              }),
              "positions: 24 values are too few for 26 vertices of 3");
    FinerSurface::Sampler sampler(*subject.finer);
    std::vector<double> const s{0.5, 0.5}, t{0.5, -3.0};
    std::vector<Eigen::Vector3d> points(2);
    EXPECT_EQ(test::RefusalOf([&] { sampler.Evaluate(77, 0, s, s, points); }),
              "face 77 does not exist; the surface has 6 faces, 0 to 5");
    EXPECT_EQ(test::RefusalOf([&] { sampler.Evaluate(0, 1, s, s, points); }),
              "domain 1 does not exist; face 0 has domains 0 to 0");
    EXPECT_EQ(test::RefusalOf([&] { sampler.Evaluate(0, 0, s, t, points); }),
              "place 1: (0.5, -3) lies outside domain 0 of face 0");
    EXPECT_EQ(test::RefusalOf([&] { sampler.Evaluate(0, 0, s, s, std::span(points).first(1)); }),
              "results: room for 1 is too little for 2 places");
}

}  // namespace
}  // namespace limn
