// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/audit/gauss_bonnet.h"

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "engine/bake/audit/extraordinary_discs.h"
#include "far_ext/topology/refiner.h"
#include "support/meshes.h"

namespace limn {
namespace {

using engine::Scene;

/// A bake's report as far as the sum over texels reads it.
engine::BakeReport MakeReport() {
    engine::BakeReport report;
    report.tiles = {1001};
    return report;
}

engine::GaussBonnetAudit GaussBonnetOf(Scene const& scene, int size) {
    engine::BakeOptions options;
    options.width = options.height = size;
    auto const report = MakeReport();
    engine::Job const job;
    auto const audits = engine::AuditGaussBonnet(
        engine::AuditInput(engine::Model::Build(scene), options, report, job));
    EXPECT_EQ(audits.size(), 1u);
    return audits.at(0);
}

/// Each face gets a cell of a grid for its own, and bilinear texture coordinates: quads fill
/// theirs, so that charts end where texels do and only extraordinary vertices disturb the sum. In
/// cells of 200 texels triangles' legs do so, too, and the third side passes between texel centres.
void GiveEachFaceACell(Scene& scene, int cellsPerSide) {
    std::vector<Index> indices;
    for (Index face = 0; face < scene.cage.GetNumFaces(); ++face) {
        double const u = face % cellsPerSide, v = face / cellsPerSide;
        int const size = scene.cage.faceSizes[face];
        for (int k = 0; k < size; ++k) {
            double const x = size == 4 ? (k == 1 || k == 2) : 0.1 + 0.8025 * (k == 1);
            double const y = size == 4 ? (k >= 2) : 0.1 + 0.8025 * (k == 2);
            indices.push_back(static_cast<Index>(scene.uvs.size() / 2));
            scene.uvs.insert(scene.uvs.end(), {(u + x) / cellsPerSide, (v + y) / cellsPerSide});
        }
    }
    scene.cage.options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_ALL);
    scene.cage.fvarChannels.push_back(
        {static_cast<Index>(scene.uvs.size() / 2), std::move(indices)});
}

/// A closed, egg-shaped mesh of 6n quads with two poles of valence n, 2n vertices of valence 3 next
/// to them, and otherwise regular ones. In texture space a grid of 7 x 7 cells (n <= 8) or 9 x 9.
Scene MakeLantern(int n) {
    double const pi = std::acos(-1.0);
    std::vector<double> positions{0, 0, 1.3, 0, 0, -1};
    for (int ring = 0; ring < 3; ++ring) {
        double const height[3] = {0.7, 0.1, -0.6}, radius[3] = {0.7, 1.0, 0.8};
        for (int k = 0; k < 2 * n; ++k) {
            double const angle = pi * k / n;
            positions.insert(positions.end(), {radius[ring] * std::cos(angle),
                                               radius[ring] * std::sin(angle), height[ring]});
        }
    }
    auto const at = [&](int ring, int k) { return 2 + 2 * n * ring + k % (2 * n); };
    std::vector<std::vector<Index>> faces;
    for (int k = 0; k < 2 * n; k += 2) {
        faces.push_back({0, at(0, k), at(0, k + 1), at(0, k + 2)});
        faces.push_back({1, at(2, k + 2), at(2, k + 1), at(2, k)});
    }
    for (int ring = 0; ring < 2; ++ring) {
        for (int k = 0; k < 2 * n; ++k)
            faces.push_back({at(ring + 1, k), at(ring + 1, k + 1), at(ring, k + 1), at(ring, k)});
    }
    Scene scene = test::MakeScene(std::move(positions), faces);
    GiveEachFaceACell(scene, n <= 8 ? 7 : 9);
    return scene;
}

class Lantern : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Valences, Lantern, testing::Values(5, 6, 8, 12));

TEST_P(Lantern, WithDiscsTheSumIsNearer) {
    Scene const scene = MakeLantern(GetParam());
    int const cells = GetParam() <= 8 ? 7 : 9;
    for (int texels : {12, 16, 24, 32}) {
        auto const audit = GaussBonnetOf(scene, cells * texels);
        ASSERT_TRUE(audit.wasAudited) << audit.reason;
        EXPECT_NEAR(audit.expected, 4 * std::acos(-1.0), 1e-12);
        double const apart = std::abs(audit.integral - audit.expected),
                     alone = std::abs(audit.texelSum - audit.expected);
        EXPECT_LT(apart, 0.5 * alone) << texels << " texels per face";
        EXPECT_LT(audit.relativeError, 1e-3) << texels << " texels per face";
    }
}

// At valence 3 curvature falls to zero, and texels alone do well; discs must not spoil it.
TEST(GaussBonnet, HoldsWhereAllExtraordinaryVerticesHaveValenceThree) {
    EXPECT_LT(GaussBonnetOf(MakeLantern(3), 7 * 16).relativeError, 5e-4);
}

// Texels alone gain less than the square of their number, which is what the sum gains where
// curvature is smooth.
TEST(GaussBonnet, WithDiscsTheSumConvergesQuadratically) {
    Scene const scene = MakeLantern(8);
    auto const coarse = GaussBonnetOf(scene, 7 * 16), fine = GaussBonnetOf(scene, 7 * 64);
    EXPECT_LT(std::abs(fine.integral - fine.expected),
              std::abs(coarse.integral - coarse.expected) / 14);
    EXPECT_GT(std::abs(fine.texelSum - fine.expected),
              std::abs(coarse.texelSum - coarse.expected) / 14);
}

// spot has triangles and pentagons among its quads, whose centres are extraordinary, and seams
// through them.
TEST(GaussBonnet, SpotGainsByDiscs) {
    Scene const spot = test::LoadSpot();
    double apart = 0.0, alone = 0.0;
    for (int size : {500, 600, 700}) {
        auto const audit = GaussBonnetOf(spot, size);
        ASSERT_TRUE(audit.wasAudited) << audit.reason;
        apart += std::abs(audit.integral - audit.expected);
        alone += std::abs(audit.texelSum - audit.expected);
    }
    EXPECT_LT(apart, 0.5 * alone);
}

// An octahedron whose faces are cut in 16: six vertices of valence 4 among those of 6.
TEST(GaussBonnet, HoldsOnLoopSurfaces) {
    std::vector<double> positions;
    std::vector<std::vector<Index>> faces;
    std::map<std::array<int, 3>, Index> vertices;
    constexpr int kCuts = 4;
    auto const vertex = [&](std::array<int, 3> const& place) {
        auto const [found, isNew] =
            vertices.try_emplace(place, static_cast<Index>(positions.size() / 3));
        double const length = std::hypot(place[0], place[1], 1.2 * place[2]);
        if (isNew)
            positions.insert(positions.end(),
                             {place[0] / length, place[1] / length, place[2] / length});
        return found->second;
    };
    for (int octant = 0; octant < 8; ++octant) {
        int const sx = octant & 1 ? -1 : 1, sy = octant & 2 ? -1 : 1, sz = octant & 4 ? -1 : 1;
        auto const at = [&](int i, int j) {
            return vertex({sx * i, sy * j, sz * (kCuts - i - j)});
        };
        auto const add = [&](Index a, Index b, Index c) {
            if (sx * sy * sz > 0)
                faces.push_back({a, b, c});
            else
                faces.push_back({a, c, b});
        };
        for (int i = 0; i < kCuts; ++i) {
            for (int j = 0; i + j < kCuts; ++j) {
                add(at(i, j), at(i + 1, j), at(i, j + 1));
                if (i + j + 1 < kCuts) add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            }
        }
    }
    Scene scene = test::MakeScene(std::move(positions), faces, Sdc::SCHEME_LOOP);
    GiveEachFaceACell(scene, 12);
    engine::BakeOptions options;
    options.width = options.height = 2400;
    auto const report = MakeReport();
    engine::Job const job;
    engine::AuditInput const input(engine::Model::Build(scene), options, report, job);
    EXPECT_EQ(engine::ExtraordinaryDiscs(input, std::vector<char>(faces.size(), 1)).GetNumDiscs(),
              6u);
    auto const audit = engine::AuditGaussBonnet(input).at(0);
    EXPECT_TRUE(audit.wasAudited) << audit.reason;
    EXPECT_LT(audit.relativeError, 1e-3);
}

class DiscsOf : public testing::Test {
protected:
    engine::ExtraordinaryDiscs MakeDiscs(Scene const& scene, int size) {
        _options.width = _options.height = size;
        _input = std::make_unique<engine::AuditInput>(engine::Model::Build(scene), _options,
                                                      _report, _job);
        return {*_input, std::vector<char>(scene.cage.faceSizes.size(), 1)};
    }

private:
    engine::BakeOptions _options;
    engine::BakeReport _report;
    engine::Job _job;
    std::unique_ptr<engine::AuditInput> _input;
};

// Two poles, and ten vertices of valence 3 beside each.
TEST_F(DiscsOf, EachExtraordinaryVertexHasOneIfTexelsResolveIt) {
    Scene const lantern = MakeLantern(5);
    EXPECT_EQ(MakeDiscs(lantern, 7 * 32).GetNumDiscs(), 12u);
    EXPECT_EQ(MakeDiscs(lantern, 7 * 2).GetNumDiscs(), 0u);
}

TEST_F(DiscsOf, TheCentresOfPolygonsHaveOne) {
    Scene tetrahedron = test::MakeScene({1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1},
                                        {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}});
    GiveEachFaceACell(tetrahedron, 2);
    EXPECT_EQ(MakeDiscs(tetrahedron, 256).GetNumDiscs(), 8u);  // 4 vertices, 4 faces
}

// The pole, corner 0 of face 0, is the disc's; the middle of a face belongs to texels, whose share
// lies between.
TEST_F(DiscsOf, TheShareOfTexelsRisesFromTheVertex) {
    Scene const lantern = MakeLantern(5);
    auto const discs = MakeDiscs(lantern, 7 * 64);
    EXPECT_EQ(discs.GetTexelShare(0, 0, 0.0, 0.0), 0.0);
    EXPECT_EQ(discs.GetTexelShare(0, 0, 0.5, 0.5), 1.0);
    double last = 0.0;
    for (double s = 0.0; s <= 0.5; s += 1.0 / 64) {
        double const share = discs.GetTexelShare(0, 0, s, 0.0);
        EXPECT_GE(share, last);
        last = share;
    }
}

TEST(GaussBonnet, IsTheSameForAnyNumberOfThreads) {
    Scene const spot = test::LoadSpot();
    auto const many = GaussBonnetOf(spot, 300);
    tbb::global_control const one(tbb::global_control::max_allowed_parallelism, 1);
    auto const single = GaussBonnetOf(spot, 300);
    EXPECT_EQ(many.integral, single.integral);
    EXPECT_EQ(many.relativeError, single.relativeError);
}

TEST(GaussBonnet, OpenAndCreasedComponentsAreListedWithTheReason) {
    Scene lantern = MakeLantern(5);
    lantern.cage.cornerVertices = {0};
    lantern.cage.cornerSharpness = {10.0f};
    EXPECT_EQ(GaussBonnetOf(lantern, 70).reason, "it has infinitely sharp corners");
    lantern.cage.cornerSharpness = {2.0f};
    EXPECT_TRUE(GaussBonnetOf(lantern, 7 * 32).wasAudited);
    lantern.cage.holes = {3};
    EXPECT_EQ(GaussBonnetOf(lantern, 70).reason, "it has a hole");
    lantern.cage.scheme = Sdc::SCHEME_BILINEAR;
    EXPECT_EQ(GaussBonnetOf(lantern, 70).reason,
              "a bilinear surface has a crease along every edge");
}

}  // namespace
}  // namespace limn
