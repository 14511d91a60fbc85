// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/preview.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <set>

#include <gtest/gtest.h>

namespace limn {
namespace {

using engine::Picture;
using engine::PreviewBuilder;
using engine::RangeKind;
using Pixel = std::array<uint8_t, 3>;

Pixel const kDark{38, 38, 38}, kWhite{255, 255, 255};

Pixel At(Picture const& picture, int x, int y) {
    uint8_t const* const pixel = picture.GetPixels() + 3 * (y * picture.GetWidth() + x);
    return {pixel[0], pixel[1], pixel[2]};
}

/// The picture of a map whose channels are value(c, x, y); the texels of `isCovered` are there.
Picture Draw(
    RangeKind range, int numChannels, int width, int height,
    std::function<double(int, int, int)> const& value,
    std::function<bool(int, int)> const& isCovered = [](int, int) { return true; }) {
    PreviewBuilder builder(range, numChannels, 0, width, height);
    for (int y = 0; y < height; ++y) {
        engine::TexelRow row;
        for (int c = 0; c < numChannels; ++c) {
            for (int x = 0; x < width; ++x)
                row.values.push_back(static_cast<float>(value(c, x, y)));
        }
        for (int x = 0; x < width; ++x) row.coverage.push_back(isCovered(x, y) ? 1.0f : 0.0f);
        row.isFilled.assign(static_cast<size_t>(width), 1);
        builder.Add(y, row.GetView());
    }
    return builder.Draw();
}

TEST(Preview, HasThePixelsOfTheMapAndALegendBelow) {
    auto const small = Draw(RangeKind::Positive, 1, 40, 30, [](int, int x, int) { return x; });
    EXPECT_EQ(small.GetWidth(), 128);  // room for the legend
    EXPECT_EQ(small.GetHeight(), 30 + 28);
    EXPECT_EQ(At(small, 40, 5), kDark);
    auto const large = Draw(RangeKind::Positive, 1, 2100, 1050, [](int, int x, int) { return x; });
    EXPECT_EQ(large.GetWidth(), 700);  // the least whole factor that leaves at most 1024
    EXPECT_EQ(large.GetHeight(), 350 + 28);
}

TEST(Preview, OneValueIsOneColourAndWhatIsNotCoveredIsDark) {
    auto const picture = Draw(
        RangeKind::Positive, 1, 64, 16, [](int, int x, int) { return x / 8; },
        [](int, int y) { return y != 3; });
    std::set<Pixel> colours;
    for (int x = 0; x < 64; ++x) {
        EXPECT_EQ(At(picture, x, 3), kDark) << x;
        EXPECT_EQ(At(picture, x, 7), At(picture, x / 8 * 8, 0)) << x;
        colours.insert(At(picture, x, 0));
    }
    EXPECT_EQ(colours.size(), 8u);
    EXPECT_FALSE(colours.contains(kDark));
}

// Values from -20 to 12: white is 0, and the colours of one sign are not those of the other.
TEST(Preview, ASignedMapHasItsZeroInTheMiddle) {
    auto const picture = Draw(RangeKind::Signed, 1, 33, 8, [](int, int x, int) { return x - 20; });
    Pixel const zero = At(picture, 20, 0), below = At(picture, 10, 0), above = At(picture, 30, 0);
    EXPECT_EQ(*std::min_element(zero.begin(), zero.end()), 247);
    EXPECT_LT(below[0], below[2]);  // blue
    EXPECT_GT(above[0], above[2]);  // red
}

TEST(Preview, VectorsAreColoursAndTheSignOfALineDoesNotMatter) {
    auto const axis = [](int c, int x, int) { return c == x / 8 ? (x % 2 ? 1.0 : -1.0) : 0.0; };
    auto const lines = Draw(RangeKind::Line, 3, 24, 8, axis);
    EXPECT_EQ(At(lines, 0, 0), (Pixel{255, 0, 0}));
    EXPECT_EQ(At(lines, 1, 0), (Pixel{255, 0, 0}));
    EXPECT_EQ(At(lines, 9, 0), (Pixel{0, 255, 0}));
    auto const normals = Draw(RangeKind::UnitVector, 3, 24, 8, axis);
    EXPECT_EQ(At(normals, 0, 0), (Pixel{0, 128, 128}));
    EXPECT_EQ(At(normals, 1, 0), (Pixel{255, 128, 128}));
}

// Figures at both ends, and between them the ramp from the colour of the least value to that of the
// largest.
TEST(Preview, TheLegendIsARampBetweenTwoFigures) {
    auto const picture =
        Draw(RangeKind::Positive, 1, 256, 16, [](int, int x, int) { return x < 128 ? 2.0 : 5.0; });
    auto const countWhite = [&](int from, int to) {
        int count = 0;
        for (int y = 16; y < 16 + 28; ++y) {
            for (int x = from; x < to; ++x) count += At(picture, x, y) == kWhite;
        }
        return count;
    };
    EXPECT_GT(countWhite(8, 20), 20);                           // 2
    EXPECT_GT(countWhite(256 - 20, 256 - 8), 20);               // 5
    EXPECT_EQ(countWhite(24, 256 - 28), 0);                     // the ramp
    EXPECT_EQ(At(picture, 24, 16 + 10), At(picture, 0, 0));     // from the least value's colour
    EXPECT_EQ(At(picture, 227, 16 + 10), At(picture, 255, 0));  // to the largest's
    std::set<Pixel> ramp;
    for (int x = 24; x < 228; ++x) ramp.insert(At(picture, x, 16 + 10));
    EXPECT_GT(ramp.size(), 100u);
}

// A flow to the right: grey streaks that change along rows less than along columns, and no legend.
TEST(Preview, AFlowIsDrawnAsStreaksAlongIt) {
    auto const picture =
        Draw(RangeKind::Flow, 2, 128, 128, [](int c, int, int) { return c == 0 ? 0.3 : 0.0; });
    ASSERT_EQ(picture.GetWidth(), 128);
    ASSERT_EQ(picture.GetHeight(), 128);
    double along = 0.0, across = 0.0;
    for (int y = 0; y < 127; ++y) {
        for (int x = 0; x < 127; ++x) {
            auto const [r, g, b] = At(picture, x, y);
            EXPECT_TRUE(r == g && g == b);
            along += std::abs(At(picture, x + 1, y)[0] - r);
            across += std::abs(At(picture, x, y + 1)[0] - r);
        }
    }
    EXPECT_LT(along, 0.5 * across);
}

}  // namespace
}  // namespace limn
