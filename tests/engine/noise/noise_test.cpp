// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "engine/noise/gradient_noise.h"
#include "engine/noise/surface_noise.h"
#include "eval/surface/surface_place.h"
#include "eval/surface/surface_sample.h"
#include "far_ext/topology/refiner.h"
#include "support/errors.h"
#include "support/listener.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using engine::GradientNoise;

TEST(GradientNoise, IsZeroAtWholeCoordinatesAndBounded) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-40.0, 40.0);
    double least = 0.0, most = 0.0, squares = 0.0;
    constexpr int kCount = 200000;
    for (int i = 0; i < kCount; ++i) {
        double const value = GradientNoise(7, place(random), place(random), place(random));
        least = std::min(least, value);
        most = std::max(most, value);
        squares += value * value;
    }
    EXPECT_GE(least, -1.0);
    EXPECT_LE(most, 1.0);
    EXPECT_LT(least, -0.4);  // and uses the range: nearly all lies within half of the bound
    EXPECT_GT(most, 0.4);
    EXPECT_GT(squares / kCount, 0.01);
    for (double x : {-3.0, 0.0, 12.0}) EXPECT_EQ(GradientNoise(7, x, 2.0, -5.0), 0.0);
}

// Two derivatives go through a lattice plane without a jump: differences on both sides agree.
TEST(GradientNoise, IsSmoothAcrossLatticePlanes) {
    double const h = 1e-4;
    for (double y : {0.3, 1.7}) {
        auto const f = [&](double x) { return GradientNoise(1, x, y, 0.45); };
        double const left = (f(3.0) - f(3.0 - h)) / h, right = (f(3.0 + h) - f(3.0)) / h;
        EXPECT_NEAR(left, right, 1e-2 * (1.0 + std::abs(left)));
        double const bendLeft = (f(3.0) - 2 * f(3.0 - h) + f(3.0 - 2 * h)) / (h * h);
        double const bendRight = (f(3.0 + 2 * h) - 2 * f(3.0 + h) + f(3.0)) / (h * h);
        EXPECT_NEAR(bendLeft, bendRight, 0.05);
    }
}

// The values every machine must give: a change of the hash or of the arithmetic shows here.
TEST(GradientNoise, HasTheSameBitsEverywhere) {
    EXPECT_EQ(GradientNoise(0, 0.5, 0.25, 0.125), -0x1.36ff0d3d5bbf4p-4);
    EXPECT_EQ(GradientNoise(42, -1234.5, 17.25, 1e6 + 0.375), -0x1.6b37cc72ada3cp-4);
    EXPECT_NE(GradientNoise(1, 0.5, 0.25, 0.125), GradientNoise(0, 0.5, 0.25, 0.125));
}

TEST(GradientNoise, TakesAnyNumber) {
    double const infinite = std::numeric_limits<double>::infinity();
    for (double x : {1e300, -1e18, infinite, std::nan("")})
        EXPECT_EQ(GradientNoise(0, x, 0.5, 0.5), 0.0) << x;
}

std::string NameOf(testing::TestParamInfo<char const*> const& cage) {
    return cage.param;
}

class SurfaceNoiseOf : public testing::TestWithParam<char const*> {};
INSTANTIATE_TEST_SUITE_P(Cages, SurfaceNoiseOf,
                         testing::Values("catmark_cube", "catmark_nonquads", "catmark_torus",
                                         "catmark_edgeonly", "catmark_dart_edgecorner",
                                         "loop_icosahedron", "loop_saddle_edgecorner"),
                         NameOf);

/// Noise at a corner of a face.
double AtCorner(engine::SurfaceNoise::Sampler& noise, eval::LimitSurface const& surface, Index face,
                int corner) {
    auto const place = eval::GetCornerPlace(surface, face, corner);
    double value = 0.0;
    noise.Evaluate(face, place.domain, {&place.s, 1}, {&place.t, 1}, {&value, 1});
    return value;
}

// No seam: every face round a vertex has the same noise there, for any number of octaves; and the
// least and largest value named are met.
TEST_P(SurfaceNoiseOf, FacesAgreeAtTheirCorners) {
    engine::Scene const scene = test::LoadShape(GetParam());
    auto const model = engine::Model::Build(scene);
    eval::LimitSurface const surface(model.GetRefiner());
    auto const& level = model.GetLevel();
    engine::Job job;
    for (int octaves : {1, 2, 4}) {
        engine::SurfaceNoise const noise(model, {.octaves = octaves, .seed = 3}, job);
        engine::SurfaceNoise::Sampler sampler(noise);
        EXPECT_LT(noise.GetLow(), noise.GetHigh());
        for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
            auto const faces = level.GetVertexFaces(vertex);
            auto const corners = level.GetVertexFaceLocalIndices(vertex);
            for (int i = 0; i < faces.size(); ++i) {
                double const value = AtCorner(sampler, surface, faces[i], corners[i]);
                EXPECT_NEAR(value, AtCorner(sampler, surface, faces[0], corners[0]), 1e-9);
                EXPECT_GE(value, noise.GetLow() - 1e-9);
                EXPECT_LE(value, noise.GetHigh() + 1e-9);
            }
        }
    }
}

// Not of a cube, whose A is singular.
class OneOctaveOf : public testing::TestWithParam<char const*> {};
INSTANTIATE_TEST_SUITE_P(Cages, OneOctaveOf,
                         testing::Values("catmark_nonquads", "catmark_torus", "catmark_edgeonly",
                                         "catmark_dart_edgecorner", "loop_icosahedron",
                                         "loop_saddle_edgecorner"),
                         NameOf);

// The surface passes through the noise at every vertex's limit point, which the exact evaluator
// finds.
TEST_P(OneOctaveOf, PassesThroughTheNoise) {
    engine::Scene const scene = test::LoadShape(GetParam());
    auto const model = engine::Model::Build(scene);
    eval::LimitSurface const surface(model.GetRefiner());
    eval::FaceTree tree(surface, scene.positions, 3);
    engine::Job job;
    engine::SurfaceNoise const noise(model, {.octaves = 1, .frequency = 1.3, .seed = 9}, job);
    engine::SurfaceNoise::Sampler sampler(noise);
    auto const& level = model.GetLevel();
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        Index const face = level.GetVertexFaces(vertex)[0];
        int const corner = level.GetVertexFaceLocalIndices(vertex)[0];
        auto const place = eval::GetCornerPlace(surface, face, corner);
        tree.Bind(face);
        double x[3];
        for (int c = 0; c < 3; ++c)
            x[c] = 1.3 * eval::EvaluateChannel(tree, place.domain, place.s, place.t, c);
        EXPECT_NEAR(AtCorner(sampler, surface, face, corner), GradientNoise(9, x[0], x[1], x[2]),
                    1e-7)
            << vertex;
    }
}

// A vertex of any level is a corner of faces of the cage, or of faces refined from it; those of the
// base level can be asked of the sampler. Levels coarser and finer than the last octave's.
TEST_P(SurfaceNoiseOf, VerticesHaveTheNoiseOfTheirPlace) {
    engine::Scene const scene = test::LoadShape(GetParam());
    auto const model = engine::Model::Build(scene);
    eval::LimitSurface const surface(model.GetRefiner());
    auto const& level = model.GetLevel();
    engine::Job job;
    for (engine::NoiseAt at : {engine::NoiseAt::Limit, engine::NoiseAt::Vertex}) {
        engine::NoiseOptions const options{.octaves = 3, .seed = 3, .at = at};
        engine::SurfaceNoise const noise(model, options, job);
        engine::SurfaceNoise::Sampler sampler(noise);
        for (int refined : {0, 1, 2, 4}) {
            auto const atVertices = engine::FindVertexNoise(model, options, refined, job);
            EXPECT_EQ(atVertices.low, noise.GetLow());
            EXPECT_EQ(atVertices.high, noise.GetHigh());
            for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
                EXPECT_NEAR(atVertices.values[vertex],
                            AtCorner(sampler, surface, level.GetVertexFaces(vertex)[0],
                                     level.GetVertexFaceLocalIndices(vertex)[0]),
                            1e-7);
            }
        }
    }
}

// The paper takes an octave's noise at the vertices of its level.
TEST_P(OneOctaveOf, AtVerticesIsThatOfTheVertices) {
    engine::Scene const scene = test::LoadShape(GetParam());
    auto const model = engine::Model::Build(scene);
    engine::Job job;
    auto const noise = engine::FindVertexNoise(
        model, {.octaves = 1, .frequency = 1.3, .seed = 9, .at = engine::NoiseAt::Vertex}, 0, job);
    for (size_t i = 0; i < noise.values.size(); ++i) {
        double const* const x = &scene.positions[3 * i];
        EXPECT_NEAR(noise.values[i], GradientNoise(9, 1.3 * x[0], 1.3 * x[1], 1.3 * x[2]), 1e-7);
    }
    EXPECT_TRUE(noise.singularLevels.empty());
}

// On a cube A has no inverse: k, +1 and -1 in turn, is what no control values reach. The noise
// passes through N - k (k.N)/(k.k) instead, with a warning.
TEST(SurfaceNoise, OnSingularMeshesIsFreedOfWhatAlternates) {
    engine::Scene cube = test::MakeCube();
    for (size_t i = 0; i < cube.positions.size(); ++i)
        cube.positions[i] += 0.1 * std::sin(static_cast<double>(7 * i));
    auto const model = engine::Model::Build(cube);
    test::Listener listener;
    engine::Job job(listener.MakeHost());
    auto const noise = engine::FindVertexNoise(
        model, {.octaves = 1, .frequency = 1.3, .seed = 9, .at = engine::NoiseAt::Vertex}, 0, job);
    EXPECT_EQ(noise.singularLevels, std::vector<int>{0});
    ASSERT_EQ(listener.warnings.size(), 1u);
    std::vector<double> signs(8, 0.0), N;
    signs[0] = 1.0;
    for (int sweep = 0; sweep < 3; ++sweep) {
        for (Index edge = 0; edge < model.GetLevel().GetNumEdges(); ++edge) {
            auto const ends = model.GetLevel().GetEdgeVertices(edge);
            for (int i : {0, 1}) {
                if (signs[ends[i]] == 0.0) signs[ends[i]] = -signs[ends[1 - i]];
            }
        }
    }
    double alternating = 0.0;
    for (size_t i = 0; i < 8; ++i) {
        double const* const x = &cube.positions[3 * i];
        N.push_back(GradientNoise(9, 1.3 * x[0], 1.3 * x[1], 1.3 * x[2]));
        alternating += signs[i] * N[i] / 8.0;
    }
    EXPECT_GT(std::abs(alternating), 1e-3);  // else nothing is shown
    for (size_t i = 0; i < 8; ++i)
        EXPECT_NEAR(noise.values[i], N[i] - signs[i] * alternating, 1e-8);
}

TEST(SurfaceNoise, IsSingularOnTheFirstLevelOnly) {
    engine::Job job;
    auto const cube = engine::Model::Build(test::MakeCube());
    EXPECT_EQ(engine::SurfaceNoise(cube, {.octaves = 3}, job).GetSingularLevels(),
              std::vector<int>{0});
    auto const torus = engine::Model::Build(test::MakeTorus(9, 7));
    EXPECT_TRUE(engine::SurfaceNoise(torus, {.octaves = 3}, job).GetSingularLevels().empty());
}

TEST(SurfaceNoise, WhatIsNoFrequencyOrNumberOfOctavesIsRefused) {
    auto const model = engine::Model::Build(test::MakeCube());
    engine::Job job;
    auto const code = [&](engine::NoiseOptions const& options) {
        return test::CodeOf([&] { engine::SurfaceNoise(model, options, job); });
    };
    EXPECT_FALSE(code({.octaves = 1, .frequency = 2.0}));
    for (int octaves : {-1, 0, 11})
        EXPECT_EQ(code({.octaves = octaves}), ErrorCode::BadOption) << octaves;
    for (double frequency : {-1.0, 0.0, double(NAN), double(INFINITY)})
        EXPECT_EQ(code({.frequency = frequency}), ErrorCode::BadOption) << frequency;
}

TEST(SurfaceNoise, StopsWhereItsHostWants) {
    auto const model = engine::Model::Build(test::MakeTorus(9, 7));
    EXPECT_TRUE(test::StopsHalfway(
        [&](engine::Job& job) { engine::SurfaceNoise(model, {.octaves = 3}, job); }));
}

TEST(SurfaceNoise, AnEvaluatorIsNearTheDoubles) {
    auto const model = engine::Model::Build(test::LoadSpot());
    engine::Job job;
    auto const expected = engine::FindVertexNoise(model, {}, 2, job);
    for (auto kind : {eval::EvaluatorKind::OsdCpu, eval::EvaluatorKind::Simd}) {
        eval::TableEvaluator door(kind);
        auto const found = engine::FindVertexNoise(model, {.evaluator = &door}, 2, job);
        EXPECT_LT(test::LargestDifference(found.values, expected.values), 1e-5);
        ASSERT_EQ(door.GetUses().size(), 1u);
        EXPECT_EQ(door.GetUses()[0].what, "S0");
        EXPECT_EQ(door.GetUses()[0].applications, 6u);  // positions and noise, to three octaves
    }
}

}  // namespace
}  // namespace limn
