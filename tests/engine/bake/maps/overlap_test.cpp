// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "engine/bake/bake.h"
#include "engine/bake/mip_chain.h"
#include "support/meshes.h"
#include "support/threads.h"

namespace limn {
namespace {

using Values = std::vector<float>;

/// A quad over u from 0 to 3/4, and one over u from 1/4 to 1, both over v from 1/4 to 3/4.
engine::Model MakeTwoQuads() {
    engine::Scene scene =
        test::MakeScene({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 5, 0, 0, 6, 0, 0, 6, 1, 0, 5, 1, 0},
                        {{0, 1, 2, 3}, {4, 5, 6, 7}});
    scene.uvs = {0,    0.25, 0.75, 0.25, 0.75, 0.75, 0,    0.75,
                 0.25, 0.25, 1,    0.25, 1,    0.75, 0.25, 0.75};
    scene.cage.fvarChannels.push_back({8, scene.cage.faceVertices});
    return engine::Model::Build(std::move(scene));
}

engine::BakeOptions MakeOptions(int size) {
    engine::BakeOptions options;
    options.maps = {"overlap"};
    options.width = options.height = size;
    return options;
}

Values BakeOverlap(engine::Model const& model, engine::BakeOptions const& options) {
    engine::Job job;
    auto const baked = engine::BakeToMemory(model, options, job);
    return baked.images.at(0).texels;
}

/// 1 where one quad lies, 2 where both do, of 8 x 8 texels; 0 elsewhere, padding or not.
Values const kExpected = [] {
    Values values;
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x)
            values.push_back(y < 2 || y >= 6 ? 0.0f : x >= 2 && x < 6 ? 2.0f : 1.0f);
    }
    return values;
}();

TEST(OverlapMap, CountsFacesAndIsZeroWhereThereIsNone) {
    EXPECT_EQ(BakeOverlap(MakeTwoQuads(), MakeOptions(8)), kExpected);
}

// Samples are averaged; a count is that of the texel's centre, and padding has no faces.
TEST(OverlapMap, IsThatOfTexelCentresHoweverManySamples) {
    for (int samples : {2, 3}) {
        auto options = MakeOptions(8);
        options.samplesPerSide = samples;
        EXPECT_EQ(BakeOverlap(MakeTwoQuads(), options), kExpected) << samples;
    }
}

TEST(OverlapMap, IsTheSameForAnyNumberOfThreadsAndInCompany) {
    auto const model = engine::Model::Build(test::LoadAsset("control/pyramid_corners.obj"));
    auto options = MakeOptions(300);
    Values const alone = BakeOverlap(model, options);
    EXPECT_GT(std::ranges::count(alone, 1.0f), 20000);
    for (int threads : {1, 4})
        test::WithThreads(threads, [&] { EXPECT_EQ(BakeOverlap(model, options), alone); });
    options.maps = {"overlap", "mean", "normal"};
    EXPECT_EQ(BakeOverlap(model, options), alone);
}

TEST(OverlapMap, EncodesCountsAndLeavesNothingAlone) {
    auto options = MakeOptions(8);
    options.encoding = engine::Encoding{0.5, 10.0};
    Values const values = BakeOverlap(MakeTwoQuads(), options);
    EXPECT_EQ(std::set<float>(values.begin(), values.end()), (std::set<float>{0.0f, 10.5f, 11.0f}));
}

// Of the texels below, the largest: no overlap gets lost on the way up.
TEST(OverlapMap, MipLevelsHoldTheLargestCount) {
    engine::TexelRow rows[2];
    std::vector<Values> levels;
    engine::MipChain chain(4, 2, 3, 1, {{0, 1, engine::Averaging::Count}},
                           [&](int, int, engine::TexelRowView const& row) {
                               levels.push_back({row.values, row.values + 1});
                           });
    rows[0].values = {1, 1, 1, 0};
    rows[1].values = {1, 2, 1, 1};
    for (engine::TexelRow& row : rows) {
        row.coverage.assign(4, 1.0f);
        row.isFilled.assign(4, 1);
    }
    rows[0].coverage[3] = 0.0f;
    std::vector<engine::TexelRowView> const views{rows[0].GetView(), rows[1].GetView()};
    chain.Add(views);
    EXPECT_EQ(levels, (std::vector<Values>{{2}, {2}}));
}

TEST(OverlapMap, NeedsNoSurface) {
    auto options = MakeOptions(8);
    engine::Job job;
    auto const report = engine::BakeToMemory(MakeTwoQuads(), options, job).report;
    EXPECT_EQ(report.overlaps, 16u);
    EXPECT_EQ(report.movedSamples, 0u);
    EXPECT_EQ(report.overlap.faces, (std::array<Index, 2>{0, 1}));
}

}  // namespace
}  // namespace limn
