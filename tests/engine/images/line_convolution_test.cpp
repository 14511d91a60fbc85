// SPDX-License-Identifier: Apache-2.0
#include "engine/images/line_convolution.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace limn {
namespace {

/// Mean product of neighbours' deviations from the mean, a step of (dx, dy) apart.
double Correlate(std::vector<uint8_t> const& grey, int size, int dx, int dy) {
    double mean = 0.0, sum = 0.0;
    for (uint8_t value : grey) mean += value / static_cast<double>(grey.size());
    int count = 0;
    for (int y = 0; y + dy < size; ++y) {
        for (int x = 0; x + dx < size; ++x, ++count) {
            sum += (grey[static_cast<size_t>(y * size + x)] - mean) *
                   (grey[static_cast<size_t>((y + dy) * size + x + dx)] - mean);
        }
    }
    return sum / count;
}

// Streaks run along the flow: neighbours along it are alike, neighbours across it are not.
TEST(LineConvolution, BlursAlongTheFlowOnly) {
    constexpr int kSize = 256;
    for (bool isAcross : {false, true}) {
        std::vector<float> flow;
        for (int i = 0; i < kSize * kSize; ++i)
            flow.insert(flow.end(), {isAcross ? 0.0f : 3.0f, isAcross ? -0.01f : 0.0f});
        auto const grey =
            engine::ConvolveLines(kSize, kSize, flow, std::vector<uint8_t>(kSize * kSize, 1));
        double const along = Correlate(grey, kSize, isAcross ? 0 : 1, isAcross ? 1 : 0),
                     across = Correlate(grey, kSize, isAcross ? 1 : 0, isAcross ? 0 : 1);
        EXPECT_GT(along, 0.8 * Correlate(grey, kSize, 0, 0));
        EXPECT_LT(std::abs(across), 0.2 * along);
    }
}

TEST(LineConvolution, StaysInside) {
    std::vector<float> const flow(2 * 8 * 8, 1.0f);
    std::vector<uint8_t> isInside(64, 0);
    isInside[27] = 1;
    auto const grey = engine::ConvolveLines(8, 8, flow, isInside);
    for (size_t i = 0; i < grey.size(); ++i) EXPECT_EQ(grey[i] > 0, i == 27);
}

// Where it ends at once, a streamline is its own texel, whose noise is left as it was.
TEST(LineConvolution, AFieldThatVanishesOrIsNoNumberEndsStreamlines) {
    std::vector<uint8_t> const inside(64, 1);
    auto const still = engine::ConvolveLines(8, 8, std::vector<float>(128, 0.0f), inside),
               none = engine::ConvolveLines(
                   8, 8, std::vector<float>(128, std::numeric_limits<float>::quiet_NaN()), inside),
               flowing = engine::ConvolveLines(8, 8, std::vector<float>(128, 1.0f), inside);
    EXPECT_EQ(still, none);
    EXPECT_NE(still, flowing);
    EXPECT_LT(*std::min_element(still.begin(), still.end()),
              *std::max_element(still.begin(), still.end()));
}

}  // namespace
}  // namespace limn
