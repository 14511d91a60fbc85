// SPDX-License-Identifier: Apache-2.0
#include "engine/measure/measure.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "far_ext/topology/refiner.h"
#include "support/fit_meshes.h"
#include "support/listener.h"
#include "support/meshes.h"

namespace limn {
namespace {

using engine::MeasuredSurface;
using std::numbers::pi;

engine::Measurement MeasureScene(engine::Scene const& scene, MeasuredSurface surface,
                                 Orientation orientation = Orientation::Right) {
    engine::Job job;
    return engine::Measure(engine::Model::Build(scene), surface, orientation, job);
}

// A box of 2 x 2 x 2 under the bilinear scheme, or as a mesh: 24, 8, Euler's 2.
TEST(Measure, ACubeHasItsAreaAndVolume) {
    auto scene = test::MakeCube();
    auto const mesh = MeasureScene(scene, MeasuredSurface::Mesh);
    EXPECT_NEAR(mesh.area, 24.0, 1e-12);
    ASSERT_TRUE(mesh.volume);
    EXPECT_NEAR(*mesh.volume, 8.0, 1e-12);
    EXPECT_EQ(mesh.eulerCharacteristic, 2);
    EXPECT_NEAR(*MeasureScene(scene, MeasuredSurface::Mesh, Orientation::Left).volume, -8.0, 1e-12);
    scene.cage.scheme = Sdc::SCHEME_BILINEAR;
    auto const limit = MeasureScene(scene, MeasuredSurface::Limit);
    EXPECT_NEAR(limit.area, 24.0, 1e-12);
    EXPECT_NEAR(*limit.volume, 8.0, 1e-12);
    EXPECT_FALSE(limit.gaussBonnet[0].wasAudited);
}

// A face that is wound against the others: what it adds to the volume has the wrong sign.
TEST(Measure, WhereWindingsDisagreeThereIsNoVolume) {
    auto scene = test::MakeCube();
    std::swap(scene.cage.faceVertices[1], scene.cage.faceVertices[3]);
    for (MeasuredSurface surface : {MeasuredSurface::Limit, MeasuredSurface::Mesh})
        EXPECT_FALSE(MeasureScene(scene, surface).volume);
}

TEST(Measure, ABodySeenInsideOutIsSaidWithTheCure) {
    auto scene = test::MakeCube();
    scene.path = "cube.obj";
    auto const measure = [&](Orientation orientation) {
        engine::Job job;
        engine::Measure(engine::Model::Build(scene), MeasuredSurface::Mesh, orientation, job);
        return job.GetWarnings();
    };
    std::string const message =
        "cube.obj: the volume is negative: the surface is seen inside out; `orientation` ";
    EXPECT_TRUE(measure(Orientation::Right).empty());
    EXPECT_EQ(measure(Orientation::Left), std::vector<std::string>{message + "right turns it"});
    for (size_t face = 0; face < 6; ++face)
        std::swap(scene.cage.faceVertices[4 * face + 1], scene.cage.faceVertices[4 * face + 3]);
    EXPECT_TRUE(measure(Orientation::Left).empty());
    EXPECT_EQ(measure(Orientation::Right), std::vector<std::string>{message + "left turns it"});
}

// A fine torus of radii 1 and 0.4: area 4 pi^2 R r, volume 2 pi^2 R r^2, mean of H 1 / 2r, of K 0.
TEST(Measure, ATorusHasItsClosedForms) {
    auto scene = test::MakeTorus(64, 40);
    for (size_t v = 0; v < scene.positions.size() / 3; ++v) {
        double const a = 2.0 * pi * static_cast<double>(v / 40) / 64,
                     b = 2.0 * pi * static_cast<double>(v % 40) / 40;
        double const p[] = {(1 + 0.4 * std::cos(b)) * std::cos(a),
                            (1 + 0.4 * std::cos(b)) * std::sin(a), 0.4 * std::sin(b)};
        for (size_t c = 0; c < 3; ++c) scene.positions[3 * v + c] = p[c];
    }
    for (MeasuredSurface surface : {MeasuredSurface::Limit, MeasuredSurface::Mesh}) {
        auto const found = MeasureScene(scene, surface);
        EXPECT_NEAR(found.area, 4.0 * pi * pi * 0.4, 0.01 * found.area);
        EXPECT_NEAR(std::abs(*found.volume), 2.0 * pi * pi * 0.16, 0.015 * std::abs(*found.volume));
        EXPECT_NEAR(std::abs(found.mean.mean), 1.0 / 0.8, 0.01 / 0.8);
        EXPECT_NEAR(found.gaussian.mean, 0.0, 0.02);
        EXPECT_LE(found.gaussian.min, found.gaussian.max);
        ASSERT_EQ(found.gaussBonnet.size(), 1u);
        EXPECT_TRUE(found.gaussBonnet[0].wasAudited);
        EXPECT_LT(found.gaussBonnet[0].relativeError, 0.01);
    }
}

// Curvature is unbounded at valence 5 and more; pieces that get smaller towards it still give 2 pi
// chi.
TEST(Measure, GaussBonnetHoldsAtEveryValence) {
    for (int n : {3, 4, 5, 7, 9, 12}) {
        auto const found = MeasureScene(test::MakeBipyramid(n), MeasuredSurface::Limit);
        EXPECT_NEAR(found.gaussBonnet[0].expected, 4.0 * pi, 1e-12);
        EXPECT_LT(found.gaussBonnet[0].relativeError, 2e-3) << n;
    }
    auto const cube = MeasureScene(test::MakeCube(), MeasuredSurface::Limit);
    EXPECT_LT(cube.gaussBonnet[0].relativeError, 1e-3);
}

// Components are numbered by their lowest face, and only the closed ones have something to be
// compared with.
TEST(Measure, ComponentsAreToldApart) {
    auto const scene =
        test::Join({test::MakeFan(6, Sdc::SCHEME_LOOP, 0.2, 0.0), test::MakeBipyramid(6)});
    auto const found = MeasureScene(scene, MeasuredSurface::Limit);
    ASSERT_EQ(found.gaussBonnet.size(), 2u);
    EXPECT_EQ(found.gaussBonnet[0].reason, "it is not closed");
    EXPECT_TRUE(found.gaussBonnet[1].wasAudited);
    EXPECT_FALSE(found.volume);
    EXPECT_EQ(found.eulerCharacteristic, 3);
}

TEST(Measure, VerticesGetTheirCurvature) {
    auto const model = engine::Model::Build(test::MakeTriangleTorus(12, 8));
    engine::Job job;
    for (MeasuredSurface surface : {MeasuredSurface::Limit, MeasuredSurface::Mesh}) {
        auto const found = engine::FindVertexCurvature(model, surface, Orientation::Right, job);
        ASSERT_EQ(found.k1.size(), 96u);
        for (size_t v = 0; v < found.k1.size(); ++v) {
            EXPECT_EQ(found.mean[v], 0.5 * (found.k1[v] + found.k2[v]));
            EXPECT_EQ(found.gaussian[v], found.k1[v] * found.k2[v]);
            EXPECT_GE(found.k1[v], found.k2[v]);
        }
    }
}

TEST(Measure, CurvatureBecomesPrimvars) {
    auto const model = engine::Model::Build(test::MakeCube());
    engine::VertexCurvature const curvature{{1, 2, 3, 4, 5, 6, 7, 8},
                                            std::vector<double>(8, 0.1),
                                            std::vector<double>(8, 0.2),
                                            std::vector<double>(8, 0.3)};
    auto const curved = engine::AddVertexCurvature(model, curvature);
    EXPECT_EQ(curved.positions, model.GetPositions());
    ASSERT_EQ(curved.primvars.size(), 4u);
    char const* const names[] = {"mean", "gaussian", "k1", "k2"};
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(curved.primvars[i].name, names[i]);
        EXPECT_EQ(curved.primvars[i].numChannels, 1);
    }
    EXPECT_EQ(curved.primvars[0].values, (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8}));
    EXPECT_EQ(curved.primvars[3].values, std::vector<float>(8, 0.3f));
}

TEST(Measure, StopsWhereItsHostWants) {
    auto const model = engine::Model::Build(test::MakeTorus(16, 12));
    EXPECT_TRUE(test::StopsHalfway([&](engine::Job& job) {
        engine::Measure(model, MeasuredSurface::Limit, Orientation::Right, job);
    }));
    EXPECT_TRUE(test::StopsHalfway([&](engine::Job& job) {
        engine::FindVertexCurvature(model, MeasuredSurface::Limit, Orientation::Right, job);
    }));
}

}  // namespace
}  // namespace limn
