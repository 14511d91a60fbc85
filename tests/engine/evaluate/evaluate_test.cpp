// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/evaluate.h"

#include <cmath>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "eval/surface/vertex_limits.h"
#include "support/fit_meshes.h"
#include "support/listener.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using engine::Job;
using engine::LimitValues;
using engine::Model;

/// Places of a grid on every face.
struct Places {
    std::vector<Index> faces;
    std::vector<double> s, t;

    Places(Model const& model, int perSide) {
        for (Index face = 0; face < model.GetCage().GetNumFaces(); ++face) {
            for (int i = 0; i < perSide * perSide; ++i) {
                faces.push_back(face);
                s.push_back((i % perSide + 0.5) / perSide);
                t.push_back((i / perSide + 0.5) / perSide);
            }
        }
    }
    engine::PlaceArrays Get() const { return {faces, s, t}; }
};

LimitValues Evaluate(Model const& model, engine::PlaceArrays const& places,
                     Orientation orientation = Orientation::Right) {
    Job job;
    return engine::EvaluateLimit(model, places, orientation, job);
}

bool IsRegular(Model const& model, Index face) {
    for (Index vertex : model.GetLevel().GetFaceVertices(face))
        if (model.GetLevel().GetVertexFaces(vertex).size() != 4) return false;
    return true;
}

// Coordinates and unit normals of a sphere agree, and all curvatures are 1, as far as the cage is
// fine (quads of an eighth) and regular: at valence 3 curvature does not converge with the cage.
TEST(EvaluateLimit, ASphereHasTheCurvatureOfASphere) {
    Model const model = Model::Build(test::MakeQuadSphere(3));
    Places const places(model, 2);
    auto const found = Evaluate(model, places.Get());
    ASSERT_EQ(found.mean.size(), places.faces.size());
    ASSERT_EQ(found.positions.size(), 3 * places.faces.size());
    EXPECT_EQ(found.CountWithoutLimit(), 0u);
    size_t numRegular = 0;
    for (size_t i = 0; i < found.mean.size(); ++i) {
        double const* const p = &found.positions[3 * i];
        double const* const n = &found.normals[3 * i];
        double const* const d = &found.directions[3 * i];
        double const radius = std::hypot(p[0], p[1], p[2]);
        if (IsRegular(model, places.faces[i])) {
            EXPECT_NEAR(found.mean[i] * radius, 1.0, 0.05);
            ++numRegular;
        }
        EXPECT_NEAR(n[0] * p[0] + n[1] * p[1] + n[2] * p[2], radius, 0.01);
        EXPECT_NEAR(std::hypot(d[0], d[1], d[2]), 1.0, 1e-12);
        EXPECT_NEAR(d[0] * n[0] + d[1] * n[1] + d[2] * n[2], 0.0, 1e-12);
        EXPECT_NEAR(0.5 * (found.k1[i] + found.k2[i]), found.mean[i], 1e-12);
        EXPECT_NEAR(found.k1[i] * found.k2[i], found.gaussian[i], 1e-12);
    }
    EXPECT_EQ(numRegular, places.faces.size() - 4 * 24);
}

TEST(EvaluateLimit, CornersOfFacesAreTheLimitsOfTheirVertices) {
    Model const model = Model::Build(test::MakeTorus(7, 5));
    eval::LimitSurface const surface(model.GetRefiner());
    auto const limits = eval::EvaluateVertexLimits(surface, model.GetPositions(), 3);
    std::vector<Index> faces;
    std::vector<double> zeros;
    for (Index face = 0; face < model.GetCage().GetNumFaces(); ++face) {
        faces.push_back(face);
        zeros.push_back(0.0);
    }
    auto const found = Evaluate(model, {faces, zeros, zeros});
    for (size_t face = 0; face < faces.size(); ++face) {
        size_t const vertex = static_cast<size_t>(model.GetCage().faceVertices[4 * face]);
        for (size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(found.positions[3 * face + c], limits.values[3 * vertex + c], 1e-12);
    }
}

TEST(EvaluateLimit, OrientationTurnsNormalsAndMeanCurvatureRound) {
    Model const model = Model::Build(test::MakeTorus(7, 5));
    Places const places(model, 2);
    auto const right = Evaluate(model, places.Get()),
               left = Evaluate(model, places.Get(), Orientation::Left);
    EXPECT_EQ(left.positions, right.positions);
    for (size_t i = 0; i < right.mean.size(); ++i) {
        EXPECT_EQ(left.mean[i], -right.mean[i]);
        EXPECT_EQ(left.gaussian[i], right.gaussian[i]);
        for (size_t c = 3 * i; c < 3 * i + 3; ++c) EXPECT_EQ(left.normals[c], -right.normals[c]);
    }
}

TEST(EvaluateLimit, AHoleHasNoLimitAndSaysSo) {
    engine::Scene scene = test::MakeTorus(7, 5);
    scene.cage.holes = {3};
    Model const model = Model::Build(scene);
    std::vector<Index> const faces{2, 3, 4};
    std::vector<double> const middle(3, 0.5);
    auto const found = Evaluate(model, {faces, middle, middle});
    EXPECT_EQ(found.CountWithoutLimit(), 1u);
    EXPECT_EQ(found.hasLimit, (std::vector<char>{1, 0, 1}));
    EXPECT_TRUE(std::isnan(found.mean[1]));
    for (size_t c = 0; c < 3; ++c) {
        EXPECT_TRUE(std::isfinite(found.positions[c]));
        EXPECT_TRUE(std::isnan(found.positions[3 + c]));
        EXPECT_TRUE(std::isnan(found.normals[3 + c]));
        EXPECT_TRUE(std::isnan(found.directions[3 + c]));
    }
}

TEST(EvaluateLimit, NoPlacesHaveNoValues) {
    auto const found = Evaluate(Model::Build(test::MakeCube()), {});
    EXPECT_TRUE(found.positions.empty());
    EXPECT_EQ(found.CountWithoutLimit(), 0u);
}

TEST(EvaluateLimit, SameBitsWhateverTheThreads) {
    Model const model = Model::Build(test::MakeTorus(7, 5));
    Places const places(model, 6);
    auto const first = Evaluate(model, places.Get());
    tbb::global_control const limit(tbb::global_control::max_allowed_parallelism, 1);
    auto const second = Evaluate(model, places.Get());
    EXPECT_EQ(first.positions, second.positions);
    EXPECT_EQ(first.mean, second.mean);
}

TEST(EvaluateLimit, StopsWhereItsHostWants) {
    Model const model = Model::Build(test::MakeTorus(7, 5));
    Places const places(model, 6);
    EXPECT_TRUE(test::StopsHalfway(
        [&](Job& job) { engine::EvaluateLimit(model, places.Get(), Orientation::Right, job); }));
}

}  // namespace
}  // namespace limn
