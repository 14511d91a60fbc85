// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/audit/audit.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/bake/bake.h"
#include "support/errors.h"
#include "support/files.h"
#include "support/listener.h"
#include "support/meshes.h"

namespace limn {
namespace {

using engine::AuditBounds;
using engine::AuditReport;

bool Contains(std::string const& text, std::string const& part) {
    return text.find(part) != std::string::npos;
}

/// A bake and its audit.
struct Audited {
    AuditReport report;
    std::vector<std::string> warnings;  ///< of the audit alone
};

Audited AuditOf(engine::Scene scene, AuditBounds const& bounds, int size = 64, int samples = 1,
                std::vector<std::string> maps = {"position", "mean"}) {
    test::TemporaryFolder const folder;
    auto const model = engine::Model::Build(std::move(scene));
    engine::BakeOptions options;
    options.pattern = folder / "{map}.<UDIM>.exr";
    options.maps = std::move(maps);
    options.width = options.height = size;
    options.samplesPerSide = samples;
    engine::Job silent;
    auto const bake = engine::Bake(model, options, silent);
    test::Listener listener;
    engine::Job job(listener.MakeHost());
    return {engine::Audit(model, options, bake, bounds, job), listener.warnings};
}

/// A sheet of four quads, open and in one chart.
engine::Scene MakeSheet() {
    engine::Scene sheet = test::MakeScene({0, 0, 0, 1, 0, 0, 2, 0, 0,  //
                                           0, 1, 0, 1, 1, 1, 2, 1, 0,  //
                                           0, 2, 0, 1, 2, 0, 2, 2, 0},
                                          {{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 5, 8, 7}});
    sheet.cage.fvarChannels.assign(1, {9, sheet.cage.faceVertices});
    sheet.uvs = {0, 0, 0.5, 0, 1, 0, 0, 0.5, 0.5, 0.5, 1, 0.5, 0, 1, 0.5, 1, 1, 1};
    return sheet;
}

// -------- nothing to judge

TEST(Audit, SaysWhereItHasJudgedNothingAndWhy) {
    auto const [report, warnings] = AuditOf(MakeSheet(), {});
    EXPECT_TRUE(report.misses.empty());
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_TRUE(Contains(warnings[0], "the audit has judged nothing")) << warnings[0];
    EXPECT_TRUE(Contains(warnings[0], "it is not closed (1 component)")) << warnings[0];
    EXPECT_TRUE(Contains(warnings[0], "Seams: there are none")) << warnings[0];
}

TEST(Audit, AClosedComponentIsEnough) {
    EXPECT_TRUE(AuditOf(test::MakeTorus(24, 16), {}, 128).warnings.empty());
}

// A torus with a sharp edge: seams can be looked at, and judged if there is a bound.
TEST(Audit, SeamsAreEnoughIfTheyHaveABound) {
    engine::Scene creased = test::MakeTorus(24, 16);
    creased.cage.creaseVertexPairs = {creased.cage.faceVertices[0], creased.cage.faceVertices[1]};
    creased.cage.creaseSharpness = {10.0f};
    auto const without = AuditOf(creased, {}).warnings;
    ASSERT_EQ(without.size(), 1u);
    EXPECT_TRUE(Contains(without[0], "it has infinitely sharp creases")) << without[0];
    EXPECT_TRUE(Contains(without[0], "Seams: reported, but not judged without `seam`"));
    EXPECT_TRUE(AuditOf(creased, {.seam = 1e9}).warnings.empty());
}

TEST(Audit, ABoundForAMapWithoutSeamsIsSaid) {
    auto const [report, warnings] = AuditOf(MakeSheet(), {.seamOfMap = {{"mean", 1.0}}});
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_TRUE(Contains(warnings[0], "no seam to compare map mean along")) << warnings[0];
}

// -------- bounds

// Texels of a size that miss a bound of nothing; the message has all that one needs to go on.
TEST(Audit, AMissedIntegralIsToldWithItsWorstFaceAndTheCure) {
    auto const [report, warnings] = AuditOf(test::LoadSpot(), {.gaussBonnet = 1e-12}, 512);
    ASSERT_EQ(report.misses.size(), 1u);
    auto const& audit = report.gaussBonnet.at(0);
    EXPECT_TRUE(audit.wasAudited);
    EXPECT_FALSE(audit.isWithin);
    ASSERT_GE(audit.worstFace, 0);
    EXPECT_GT(audit.worstFaceError, 0.0);
    std::string const& miss = report.misses[0];
    for (char const* part : {"component 0", "12.5664 is expected", "the bound is 1e-12",
                             "`width` or `samplesPerSide`"})
        EXPECT_TRUE(Contains(miss, part)) << miss;
    EXPECT_TRUE(Contains(miss, "face " + std::to_string(audit.worstFace))) << miss;
    EXPECT_TRUE(AuditOf(test::LoadSpot(), {}, 512).report.misses.empty());
}

// What all faces' texels are off by bounds what their sum is.
TEST(Audit, TheWorstFaceIsOffByItsShareAtLeast) {
    engine::Scene const spot = test::LoadSpot();
    auto const audit = AuditOf(spot, {.gaussBonnet = 1e-12}, 512).report.gaussBonnet.at(0);
    EXPECT_GE(audit.worstFaceError * spot.cage.GetNumFaces(),
              std::abs(audit.integral - audit.expected));
}

// The cure cures: four samples a texel are as good as twice the size.
TEST(Audit, SamplesOfATexelCountAsTexelsDo) {
    engine::Scene const torus = test::MakeTorus(12, 8);
    auto const fine = AuditOf(torus, {}, 128).report.gaussBonnet.at(0);
    auto const sampled = AuditOf(torus, {}, 64, 2).report.gaussBonnet.at(0);
    auto const coarse = AuditOf(torus, {}, 64).report.gaussBonnet.at(0);
    EXPECT_EQ(sampled.integral, fine.integral);
    EXPECT_NE(sampled.integral, coarse.integral);
}

TEST(Audit, SeamsKeepTheirBoundOrNot) {
    engine::Scene const torus = test::MakeTorus(24, 16);
    auto const seams = AuditOf(torus, {}, 128).report.seams;
    ASSERT_EQ(seams.size(), 2u);
    for (auto const& seam : seams) {
        EXPECT_FALSE(seam.bound) << seam.map;
        EXPECT_TRUE(seam.isWithin) << seam.map;
        EXPECT_GT(seam.max, 0.0) << seam.map;
    }
    double const position = seams[0].max, mean = seams[1].max;
    EXPECT_TRUE(AuditOf(torus, {.seam = std::max(position, mean)}, 128).report.misses.empty());
    AuditBounds const bounds{.seam = 1e9, .seamOfMap = {{"mean", 0.5 * mean}}};
    auto const report = AuditOf(torus, bounds, 128).report;
    EXPECT_TRUE(report.seams[0].isWithin);
    EXPECT_FALSE(report.seams[1].isWithin);
    ASSERT_EQ(report.misses.size(), 1u);
    EXPECT_TRUE(Contains(report.misses[0], "map mean")) << report.misses[0];
    EXPECT_TRUE(Contains(report.misses[0], seams[1].place)) << report.misses[0];
    EXPECT_TRUE(Contains(report.misses[0], "`width` or `samplesPerSide`")) << report.misses[0];
}

TEST(Audit, ABoundForAMapThatIsNotBakedIsRefused) {
    EXPECT_EQ(test::CodeOf([] { engine::CheckBounds({.seamOfMap = {{"k1", 1.0}}}, {"mean"}); }),
              ErrorCode::BadOption);
    EXPECT_NO_THROW(engine::CheckBounds({.seam = 1.0, .seamOfMap = {{"k1", 1.0}}}, {"mean", "k1"}));
}

}  // namespace
}  // namespace limn
