// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/mip_chain.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace limn {
namespace {

using engine::Averaging;
using engine::MipChain;
using engine::TexelRow;
using engine::TexelRowView;

TexelRow MakeRow(int width, int channels, std::mt19937& random, bool isCovered) {
    std::uniform_real_distribution<float> value(-1.0f, 1.0f);
    TexelRow row;
    for (int i = 0; i < width * channels; ++i)
        row.values.push_back(isCovered ? value(random) : 0.0f);
    row.coverage.assign(static_cast<size_t>(width), isCovered ? 1.0f : 0.0f);
    row.isFilled.assign(static_cast<size_t>(width), isCovered);
    return row;
}

/// Gives a row whose memory is gone right after.
void AddRow(MipChain& chain, TexelRow const& row) {
    TexelRowView const view = row.GetView();
    chain.Add({&view, 1});
}

// The mean over a fully covered image is the value of the 1 x 1 level, also for odd sizes, since
// boxes weigh by area.
TEST(MipChain, TheLastLevelIsTheMean) {
    for (auto const& [width, height] : {std::pair{16, 16}, {13, 7}, {1, 9}, {33, 64}}) {
        std::mt19937 random(3);
        int levels = 1;
        for (int size = std::max(width, height); size > 1; size /= 2) ++levels;
        double last = 0.0, sum = 0.0;
        MipChain chain(
            width, height, levels, 1, {{0, 1, Averaging::Plain}},
            [&](int, int, TexelRowView const& row) { last = static_cast<double>(row.values[0]); });
        for (int y = 0; y < height; ++y) {
            TexelRow const row = MakeRow(width, 1, random, true);
            for (float v : row.values) sum += static_cast<double>(v);
            AddRow(chain, row);
        }
        EXPECT_NEAR(last, sum / (width * height), 1e-5) << width << " x " << height;
    }
}

TEST(MipChain, UncoveredTexelsDoNotDarkenCoveredOnes) {
    float seen = 0.0f, coverage = 0.0f;
    MipChain chain(2, 2, 2, 1, {{0, 1, Averaging::Plain}}, [&](int, int, TexelRowView const& row) {
        seen = row.values[0];
        coverage = row.coverage[0];
    });
    AddRow(chain, {{8.0f, 0.0f}, {1.0f, 0.0f}, {1, 0}});
    AddRow(chain, {{0.0f, 0.0f}, {0.0f, 0.0f}, {0, 0}});
    EXPECT_EQ(seen, 8.0f);
    EXPECT_EQ(coverage, 0.25f);
}

TEST(MipChain, NormalsStayUnitAndLinesIgnoreSign) {
    std::vector<float> seen;
    MipChain chain(
        2, 1, 2, 6, {{0, 3, Averaging::UnitVector}, {3, 3, Averaging::Line}},
        [&](int, int, TexelRowView const& row) { seen.assign(row.values, row.values + 6); });
    // Normals x and y: their mean is at 45 degrees. Lines +z and -z: the same line.
    AddRow(chain, {{1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, -1}, {1.0f, 1.0f}, {1, 1}});
    EXPECT_NEAR(seen[0], std::sqrt(0.5f), 1e-6);
    EXPECT_NEAR(seen[1], std::sqrt(0.5f), 1e-6);
    EXPECT_NEAR(std::abs(seen[5]), 1.0f, 1e-6);
}

}  // namespace
}  // namespace limn
