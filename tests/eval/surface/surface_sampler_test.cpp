// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/surface_sampler.h"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "far_ext/topology/refiner.h"
#include "support/errors.h"
#include "support/instruction_sets.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using eval::FaceTree;
using eval::LimitSurface;
using eval::Quantity;
using eval::SurfaceSampler;

/// Samples n places of every face: planes by channel, in a fixed order.
std::vector<std::vector<float>> SampleAll(engine::Scene const& scene, Quantity quantity,
                                          int perSide) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    LimitSurface const surface(*refiner);
    FaceTree tree(surface, scene.positions, 3);
    SurfaceSampler sampler(tree, quantity, Orientation::Right);
    std::vector<std::vector<float>> planes(static_cast<size_t>(sampler.GetNumChannels()));
    std::vector<double> s, t;
    for (int j = 0; j < perSide; ++j) {
        for (int i = 0; i < perSide; ++i) {
            double const u = (i + 0.31) / perSide, v = (j + 0.43) / perSide;
            if (surface.IsLoop() && u + v > 1.0) continue;
            s.push_back(u);
            t.push_back(v);
        }
    }
    for (Index face = 0; face < surface.GetNumFaces(); ++face) {
        if (!surface.HasLimit(face)) continue;
        sampler.Bind(face);
        for (int domain = 0; domain < surface.GetNumDomains(face); ++domain) {
            size_t const start = planes[0].size();
            for (auto& plane : planes) plane.resize(start + s.size());
            sampler.Evaluate(domain, s, t,
                             [&](std::span<int const> samples, float const* p, size_t stride) {
                                 for (size_t c = 0; c < planes.size(); ++c) {
                                     for (size_t i = 0; i < samples.size(); ++i)
                                         planes[c][start + samples[i]] = p[c * stride + i];
                                 }
                             });
        }
    }
    EXPECT_FALSE(planes[0].empty());
    return planes;
}

// Second derivatives in float must keep 1e-6 of the largest value of the mesh.
TEST(SurfaceSampler, FloatAgreesWithDoubleOnARegularMesh) {
    engine::Scene const torus = test::MakeTorus(32, 16);
    auto const planes = SampleAll(torus, Quantity::Curvature, 5);
    auto const refiner = far_ext::CreateRefiner(torus.cage);
    LimitSurface const surface(*refiner);
    FaceTree tree(surface, torus.positions, 3);
    double worst = 0.0, largest = 0.0;
    size_t at = 0;
    for (Index face = 0; face < surface.GetNumFaces(); ++face) {
        tree.Bind(face);
        for (int j = 0; j < 5; ++j) {
            for (int i = 0; i < 5; ++i, ++at) {
                auto const x = eval::EvaluateSample(tree, 0, (i + 0.31) / 5, (j + 0.43) / 5);
                worst = test::Worse(worst, std::abs(static_cast<double>(planes[eval::kMean][at]) -
                                                    x.curvature.mean));
                largest = std::max(largest, std::abs(x.curvature.mean));
            }
        }
    }
    EXPECT_LT(worst, 1e-6 * largest);
}

struct AccuracyCase {
    Sdc::SchemeType scheme;
    int valence;
};
class AccuracyAtVertex : public testing::TestWithParam<AccuracyCase> {};
INSTANTIATE_TEST_SUITE_P(
    Fans, AccuracyAtVertex,
    testing::Values(AccuracyCase{Sdc::SCHEME_CATMARK, 3}, AccuracyCase{Sdc::SCHEME_CATMARK, 5},
                    AccuracyCase{Sdc::SCHEME_CATMARK, 8}, AccuracyCase{Sdc::SCHEME_LOOP, 3},
                    AccuracyCase{Sdc::SCHEME_LOOP, 6}, AccuracyCase{Sdc::SCHEME_LOOP, 9}));

// At every depth: a sample at 2^-depth from the vertex has the curvature that double finds, to 2e-6
// of its own size. (Relative to the mesh's largest value the bound is 1e-6; at valence 3 the values
// are alike.)
TEST_P(AccuracyAtVertex, CurvatureKeepsItsDigitsWithDepth) {
    engine::Scene fan = test::MakeFan(GetParam().valence, GetParam().scheme, 0.1, 0.03);
    for (size_t v = 0; v < fan.positions.size(); v += 3) {  // tilted and moved off the origin
        double const x = fan.positions[v], z = fan.positions[v + 2];
        fan.positions[v] = 5.0 + 0.8 * x - 0.6 * z;
        fan.positions[v + 2] = -3.0 + 0.6 * x + 0.8 * z;
    }
    auto const refiner = far_ext::CreateRefiner(fan.cage);
    LimitSurface const surface(*refiner);
    FaceTree tree(surface, fan.positions, 3), reference(surface, fan.positions, 3);
    SurfaceSampler sampler(tree, Quantity::Curvature, Orientation::Right);
    sampler.Bind(0);
    reference.Bind(0);
    for (int depth = 1; depth <= 20; ++depth) {
        std::vector<double> const s{std::ldexp(0.61, -depth)}, t{std::ldexp(0.35, -depth)};
        auto const expected = eval::EvaluateSample(reference, 0, s[0], t[0]).curvature;
        bool isSampled = false;
        sampler.Evaluate(0, s, t, [&](std::span<int const>, float const* p, size_t stride) {
            isSampled = true;
            double const scale = std::max(std::abs(expected.k1), std::abs(expected.k2));
            EXPECT_NEAR(static_cast<double>(p[eval::kK1 * stride]), expected.k1, 2e-6 * scale)
                << "depth " << depth;
            EXPECT_NEAR(static_cast<double>(p[eval::kK2 * stride]), expected.k2, 2e-6 * scale)
                << "depth " << depth;
            EXPECT_NEAR(static_cast<double>(p[eval::kMean * stride]), expected.mean, 2e-6 * scale)
                << "depth " << depth;
        });
        EXPECT_TRUE(isSampled);
    }
}

class SurfaceSamplerOnMesh : public testing::TestWithParam<char const*> {
protected:
    engine::Scene Load() const {
        std::string const name = GetParam();
        if (name == "fan7") return test::MakeFan(7, Sdc::SCHEME_CATMARK, 0.1, 0.05);
        if (name == "loop-fan5") return test::MakeFan(5, Sdc::SCHEME_LOOP, 0.1, 0.05);
        if (name == "loop-torus") return test::MakeTriangleTorus(12, 8);
        return test::LoadShape(name);
    }
};

TEST_P(SurfaceSamplerOnMesh, SameBitsForEveryInstructionSet) {
    engine::Scene const scene = Load();
    std::vector<std::vector<float>> first;
    test::ForEachInstructionSet([&](eval::InstructionSet set) {
        auto const planes = SampleAll(scene, Quantity::Tangents, 5);
        if (first.empty()) first = planes;
        for (size_t c = 0; c < planes.size(); ++c) {
            EXPECT_EQ(
                0, std::memcmp(planes[c].data(), first[c].data(), planes[c].size() * sizeof(float)))
                << eval::GetName(set) << " channel " << c;
        }
    });
}

TEST_P(SurfaceSamplerOnMesh, EveryValueIsFiniteAndNormalsHaveLengthOne) {
    auto const planes = SampleAll(Load(), Quantity::Tangents, 6);
    for (size_t i = 0; i < planes[0].size(); ++i) {
        for (auto const& plane : planes) ASSERT_TRUE(std::isfinite(plane[i]));
        double squares = 0.0;
        for (int c = 0; c < 3; ++c)
            squares += std::pow(static_cast<double>(planes[eval::kNormalX + c][i]), 2);
        ASSERT_NEAR(squares, 1.0, 1e-5);
    }
}

// k1 >= k2, their mean is H, their product K, and d is a unit tangent.
TEST_P(SurfaceSamplerOnMesh, CurvaturesBelongTogether) {
    auto const planes = SampleAll(Load(), Quantity::Direction, 6);
    auto const at = [&](int c, size_t i) {
        return static_cast<double>(planes[static_cast<size_t>(c)][i]);
    };
    for (size_t i = 0; i < planes[0].size(); ++i) {
        double const k1 = at(eval::kK1, i), k2 = at(eval::kK2, i),
                     scale = std::max({std::abs(k1), std::abs(k2), 1e-3});
        ASSERT_GE(k1, k2);
        ASSERT_NEAR(at(eval::kMean, i), 0.5 * (k1 + k2), 1e-5 * scale);
        ASSERT_NEAR(at(eval::kGaussian, i), k1 * k2, 1e-5 * scale * scale);
        double dn = 0.0, dd = 0.0;
        for (int c = 0; c < 3; ++c) {
            dn += at(eval::kDirectionX + c, i) * at(eval::kNormalX + c, i);
            dd += at(eval::kDirectionX + c, i) * at(eval::kDirectionX + c, i);
        }
        ASSERT_NEAR(dn, 0.0, 1e-4);
        ASSERT_NEAR(dd, 1.0, 1e-4);
    }
}

TEST(SurfaceSampler, WhatIsOutOfRangeIsRefused) {
    auto const cube = test::MakeCube();
    auto const refiner = far_ext::CreateRefiner(cube.cage);
    LimitSurface const surface(*refiner);
    FaceTree tree(surface, cube.positions, 3);
    SurfaceSampler sampler(tree, Quantity::Curvature, Orientation::Right);
    EXPECT_EQ(test::RefusalOf([&] { sampler.Bind(77); }),
              "face 77 does not exist; the surface has 6 faces, 0 to 5");
    sampler.Bind(3);
    std::vector<double> const s{0.5, 1.5}, t{0.5, -3.0};
    auto const visit = [](auto const&, auto*, size_t) { ADD_FAILURE() << "a sample was visited"; };
    EXPECT_EQ(test::RefusalOf([&] { sampler.Evaluate(1, s, s, visit); }),
              "domain 1 does not exist; face 3 has domains 0 to 0");
    EXPECT_EQ(test::RefusalOf([&] { sampler.Evaluate(0, s, t, visit); }),
              "place 1: (1.5, -3) lies outside domain 0 of face 3");
    EXPECT_EQ(test::RefusalOf([&] { sampler.Evaluate(0, s, std::span(t).first(1), visit); }),
              "places: 2 values of s and 1 of t; each has one of both");
}

TEST(SurfaceSampler, ATreeWithoutPositionsIsRefused) {
    auto const torus = test::MakeTorus(4, 3);
    auto const refiner = far_ext::CreateRefiner(torus.cage);
    LimitSurface const surface(*refiner, 0);
    FaceTree tree(surface, torus.uvs, 2);
    EXPECT_EQ(
        test::RefusalOf([&] { SurfaceSampler(tree, Quantity::Position, Orientation::Right); }),
        "channel 2 does not exist; the tree has 2");
}

INSTANTIATE_TEST_SUITE_P(Meshes, SurfaceSamplerOnMesh,
                         testing::Values("fan7", "loop-fan5", "loop-torus", "catmark_gregory_test6",
                                         "catmark_nonquads", "catmark_dart_edgecorner",
                                         "catmark_cubes_semisharp", "catmark_nonman_edges"),
                         [](testing::TestParamInfo<char const*> const& mesh) {
                             return test::NameInstance(mesh.param);
                         });

}  // namespace
}  // namespace limn
