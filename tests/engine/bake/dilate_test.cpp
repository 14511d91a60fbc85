// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/dilate.h"

#include <algorithm>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

namespace limn {
namespace {

using engine::CoverageRows;
using engine::PaddingSearch;

// Radius, and the left edge of the searched columns: at the tile's sides and within.
using Radii = std::tuple<int, int>;
class PaddingRadius : public testing::TestWithParam<Radii> {
protected:
    static int GetRadius() { return std::get<0>(GetParam()); }
    static int GetLeft() { return std::get<1>(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Radii, PaddingRadius,
                         testing::Combine(testing::Values(1, 5, 16, 64, 70),
                                          testing::Values(0, 64, 128)));

// Brute force: nearest covered texel, ties to smaller y, then smaller x.
TEST_P(PaddingRadius, FindsTheNearestCoveredTexel) {
    int const radius = GetRadius(), width = 150, height = 150;
    std::mt19937 random(7);
    std::vector<uint8_t> covered(static_cast<size_t>(width * height), 0);
    for (int i = 0; i < 60; ++i) covered[random() % covered.size()] = 1;
    CoverageRows rows{0, width, {}};
    for (int y = 0; y < height; ++y) rows.rows.push_back(&covered[static_cast<size_t>(y * width)]);
    int const first = 40, count = 64, left = GetLeft(), columns = std::min(64, width - left);
    PaddingSearch search(rows, radius);
    ASSERT_TRUE(search.Find(first, count, left, columns));
    for (int y = first; y < first + count; ++y) {
        for (int x = left; x < left + columns; ++x) {
            int best = radius * radius + 1, bestX = 0, bestY = 0;
            for (int v = 0; v < height; ++v) {
                for (int u = 0; u < width; ++u) {
                    int const distance = (u - x) * (u - x) + (v - y) * (v - y);
                    if (covered[static_cast<size_t>(v * width + u)] && distance < best) {
                        best = distance;
                        bestX = u - x;
                        bestY = v - y;
                    }
                }
            }
            int32_t const offset =
                search.GetOffsets()[static_cast<size_t>((y - first) * columns + x - left)];
            if (best > radius * radius) {
                ASSERT_EQ(offset, PaddingSearch::kNoSource) << x << " " << y;
            } else {
                ASSERT_EQ(PaddingSearch::GetOffsetX(offset), bestX) << x << " " << y;
                ASSERT_EQ(PaddingSearch::GetOffsetY(offset), bestY) << x << " " << y;
            }
        }
    }
}

}  // namespace
}  // namespace limn
