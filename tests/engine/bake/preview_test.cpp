// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/preview.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <set>

#include <gtest/gtest.h>

#include "support/errors.h"

namespace limn {
namespace {

using engine::Encoding;
using engine::MapTraits;
using engine::Picture;
using engine::Preview;
using engine::PreviewRange;
using engine::RangeKind;
using Pixel = std::array<uint8_t, 3>;

Pixel const kDark{38, 38, 38}, kWhite{255, 255, 255};

Pixel At(Picture const& picture, int x, int y) {
    uint8_t const* const pixel = picture.GetPixels() + 3 * (y * picture.GetWidth() + x);
    return {pixel[0], pixel[1], pixel[2]};
}

/// What a texel is.
enum class Texel { Covered, Padded, Empty };

/// A map of some size, whose channels are value(c, x, y).
struct Subject {
    MapTraits map;
    int width, height;
    std::function<double(int, int, int)> value;
    std::function<Texel(int, int)> texel = [](int, int) { return Texel::Covered; };
    std::optional<PreviewRange> range{};
    Encoding encoding{};
};

MapTraits MakeTraits(RangeKind range, int numChannels) {
    MapTraits map{.name = "map", .units = "1/length", .range = range};
    char const* const names[] = {"R", "G", "B"};
    map.channels.assign(names, names + numChannels);
    return map;
}

/// A preview to which the subject's rows have been added; `drawn`, if there is one, gets the rows.
Preview Draw(Subject const& subject, std::vector<std::vector<Pixel>>* drawn = nullptr) {
    Preview preview(subject.map, 0, subject.width, subject.height, subject.range, subject.encoding);
    std::vector<engine::TexelRow> rows(static_cast<size_t>(subject.height));
    int const numChannels = subject.map.GetNumChannels();
    for (int y = 0; y < subject.height; ++y) {
        engine::TexelRow& row = rows[static_cast<size_t>(y)];
        for (int c = 0; c < numChannels; ++c) {
            for (int x = 0; x < subject.width; ++x) {
                double const value = subject.value(c, x, y) * subject.encoding.scale;
                row.values.push_back(static_cast<float>(value + subject.encoding.offset));
            }
        }
        for (int x = 0; x < subject.width; ++x) {
            Texel const texel = subject.texel(x, y);
            row.coverage.push_back(texel == Texel::Covered ? 1.0f : 0.0f);
            row.isFilled.push_back(texel != Texel::Empty);
        }
        preview.Add(y, row.GetView());
    }
    preview.Prepare();
    for (int y = 0; drawn && y < subject.height; ++y) {
        std::array<float const*, 3> values{};
        for (int c = 0; c < std::min(3, numChannels); ++c)
            values[static_cast<size_t>(c)] =
                &rows[static_cast<size_t>(y)].values[static_cast<size_t>(c * subject.width)];
        std::vector<Pixel> pixels(static_cast<size_t>(subject.width));
        preview.DrawRow(y, values, pixels.data()->data());
        drawn->push_back(std::move(pixels));
    }
    return preview;
}

std::vector<std::vector<Pixel>> DrawRows(Subject const& subject) {
    std::vector<std::vector<Pixel>> rows;
    Draw(subject, &rows);
    return rows;
}

/// The first row of a map of one row whose values are these.
std::vector<Pixel> DrawValues(MapTraits const& map, std::vector<double> const& values,
                              std::optional<PreviewRange> const& range = {},
                              Encoding const& encoding = {}) {
    auto const value = [&](int, int x, int) { return values[static_cast<size_t>(x)]; };
    Subject subject{map, static_cast<int>(values.size()), 1, value};
    subject.range = range;
    subject.encoding = encoding;
    return DrawRows(subject).at(0);
}

TEST(Preview, OneValueIsOneColourAndWhatHasNoneIsDark) {
    Subject subject{MakeTraits(RangeKind::Positive, 1), 64, 16,
                    [](int, int x, int) { return x / 8; }};
    subject.texel = [](int x, int y) {
        return y != 3 ? Texel::Covered : x % 16 < 8 ? Texel::Padded : Texel::Empty;
    };
    auto const rows = DrawRows(subject);
    std::set<Pixel> colours;
    for (size_t x = 0; x < 64; ++x) {
        EXPECT_EQ(rows[3][x], x % 16 < 8 ? rows[7][x] : kDark) << x;  // padding is drawn, too
        EXPECT_EQ(rows[7][x], rows[0][x / 8 * 8]) << x;
        colours.insert(rows[0][x]);
    }
    EXPECT_EQ(colours.size(), 8u);
    EXPECT_FALSE(colours.contains(kDark));
}

// Values from -20 to 12: white is 0, and the colours of one sign are not those of the other.
TEST(Preview, ASignedMapHasItsZeroInTheMiddle) {
    std::vector<double> values;
    for (int x = -20; x <= 12; ++x) values.push_back(x);
    auto const row = DrawValues(MakeTraits(RangeKind::Signed, 1), values);
    Pixel const zero = row[20], below = row[10], above = row[30];
    EXPECT_EQ(*std::min_element(zero.begin(), zero.end()), 247);
    EXPECT_LT(below[0], below[2]);  // blue
    EXPECT_GT(above[0], above[2]);  // red
}

TEST(Preview, VectorsAreColoursAndTheSignOfALineDoesNotMatter) {
    auto const axis = [](int c, int x, int) { return c == x / 8 ? (x % 2 ? 1.0 : -1.0) : 0.0; };
    auto const lines = DrawRows({MakeTraits(RangeKind::Line, 3), 24, 1, axis})[0];
    EXPECT_EQ(lines[0], (Pixel{255, 0, 0}));
    EXPECT_EQ(lines[1], (Pixel{255, 0, 0}));
    EXPECT_EQ(lines[9], (Pixel{0, 255, 0}));
    auto const normals = DrawRows({MakeTraits(RangeKind::UnitVector, 3), 24, 1, axis})[0];
    EXPECT_EQ(normals[0], (Pixel{0, 128, 128}));
    EXPECT_EQ(normals[1], (Pixel{255, 128, 128}));
    auto const colours = DrawRows({MakeTraits(RangeKind::Colours, 3), 24, 1,
                                   [](int c, int x, int) { return c == 0 ? x / 23.0 : 0.2; }})[0];
    EXPECT_EQ(colours[0], (Pixel{0, 51, 51}));
    EXPECT_EQ(colours[23], (Pixel{255, 51, 51}));
}

// A thousand values from 1 to 2, and one of 1000 that would leave them one colour.
TEST(Preview, PercentilesLeaveOutWhatIsRareAndTheFullRangeDoesNot) {
    std::vector<double> values;
    for (int x = 0; x < 1000; ++x) values.push_back(1.0 + x / 999.0);
    values.push_back(1000.0);
    MapTraits const map = MakeTraits(RangeKind::Positive, 1);
    auto const count = [&](std::optional<PreviewRange> const& range) {
        auto const row = DrawValues(map, values, range);
        return std::set<Pixel>(row.begin(), row.end() - 1).size();
    };
    EXPECT_GT(count(std::nullopt), 100u);
    EXPECT_EQ(count(std::nullopt), count(PreviewRange::Parse("p1")));
    EXPECT_EQ(count(PreviewRange::Parse("full")), 1u);
    EXPECT_GT(count(PreviewRange::Parse("asinh")), 10u);
}

TEST(Preview, AGivenRangeIsTaken) {
    MapTraits const map = MakeTraits(RangeKind::Positive, 1);
    auto const row = DrawValues(map, {-9, 2, 3, 4, 50}, PreviewRange::Parse("2,4"));
    auto const ends = DrawValues(map, {0, 0.5, 1}, PreviewRange::Parse("0,1"));
    EXPECT_EQ(row[0], row[1]);
    EXPECT_EQ(row[3], row[4]);
    EXPECT_EQ((std::array{row[1], row[2], row[3]}), (std::array{ends[0], ends[1], ends[2]}));
}

// Linear up to the median of the magnitudes, 1: as far from 0 as asinh(1), where the end is at
// asinh(1000).
TEST(Preview, AsinhShowsSmallValuesBesideLargeOnes) {
    MapTraits const map = MakeTraits(RangeKind::Signed, 1);
    auto const row = DrawValues(map, {-1000, -1, 0, 1, 1, 1, 1000}, PreviewRange::Parse("asinh"));
    auto const share = std::asinh(1.0) / std::asinh(1000.0);
    auto const expected = DrawValues(map, {-1, -share, 0, share, 1}, PreviewRange::Parse("-1,1"));
    for (auto const& [x, y] : {std::pair{0, 0}, {1, 1}, {2, 2}, {3, 3}, {6, 4}}) {
        for (size_t c = 0; c < 3; ++c)  // bins of the median are 0.8 % wide
            EXPECT_NEAR(row[static_cast<size_t>(x)][c], expected[static_cast<size_t>(y)][c], 2)
                << x;
    }
}

TEST(Preview, LimitsOfAMapStand) {
    MapTraits map = MakeTraits(RangeKind::Signed, 1);
    map.limits = {-1.0f, 1.0f};
    auto const row = DrawValues(map, {0.0, 0.25, 0.5});
    auto const expected = DrawValues(map, {0.0, 0.25, 0.5}, PreviewRange::Parse("-1,1"));
    EXPECT_EQ(row, expected);
}

TEST(Preview, AnEncodingIsUndone) {
    for (RangeKind kind : {RangeKind::Signed, RangeKind::Positive}) {
        MapTraits const map = MakeTraits(kind, 1);
        EXPECT_EQ(DrawValues(map, {-4, 0, 1, 2}, {}, {0.5, 0.5}), DrawValues(map, {-4, 0, 1, 2}));
    }
    EXPECT_EQ(DrawValues(MakeTraits(RangeKind::Signed, 1), {-4, 0, 2}, {}, {-1.0, 0.0}),
              DrawValues(MakeTraits(RangeKind::Signed, 1), {-4, 0, 2}));
}

// A flow to the right: grey streaks that change along rows less than along columns.
TEST(Preview, AFlowIsDrawnAsStreaksAlongIt) {
    auto const rows = DrawRows({MakeTraits(RangeKind::Flow, 2), 128, 128,
                                [](int c, int, int) { return c == 0 ? 0.3 : 0.0; }});
    double along = 0.0, across = 0.0;
    for (size_t y = 0; y < 127; ++y) {
        for (size_t x = 0; x < 127; ++x) {
            auto const [r, g, b] = rows[y][x];
            EXPECT_TRUE(r == g && g == b);
            along += std::abs(rows[y][x + 1][0] - r);
            across += std::abs(rows[y + 1][x][0] - r);
        }
    }
    EXPECT_LT(along, 0.5 * across);
}

// Memory holds streaks for some thousand texels across only; the picture has all of them.
TEST(Preview, ALargeFlowHasAPixelPerTexel) {
    Subject subject{MakeTraits(RangeKind::Flow, 2), 2500, 40, [](int, int, int) { return 0.3; }};
    subject.texel = [](int x, int) { return x < 1201 ? Texel::Covered : Texel::Empty; };
    auto const rows = DrawRows(subject);
    ASSERT_EQ(rows[0].size(), 2500u);
    EXPECT_EQ(rows[7][1201], kDark);
    std::set<Pixel> greys;
    for (size_t x = 0; x < 1201; ++x) greys.insert(rows[7][x]);
    EXPECT_GT(greys.size(), 20u);
}

// -------- the legend

int CountPixels(Picture const& picture, Pixel const& pixel, int fromY, int toY) {
    int count = 0;
    for (int y = fromY; y < toY; ++y) {
        for (int x = 0; x < picture.GetWidth(); ++x) count += At(picture, x, y) == pixel;
    }
    return count;
}

Subject const kRamp{MakeTraits(RangeKind::Positive, 1), 256, 16,
                    [](int, int x, int) { return x < 128 ? 2.0 : 5.0; }};

TEST(PreviewLegend, HasTwoLinesOfTextAndABarBetweenFigures) {
    Picture const legend = Draw(kRamp).GetColours().DrawLegend("spot 1001");
    int const barY = legend.GetHeight() - 8 - 28;
    EXPECT_GT(CountPixels(legend, kWhite, 8, 28), 100);     // map and unit
    EXPECT_GT(CountPixels(legend, kWhite, 28, barY), 100);  // mesh and tile
    EXPECT_GT(CountPixels(legend, kWhite, barY, barY + 28), 40);
    std::set<Pixel> ramp;
    for (int x = 24; x < legend.GetWidth() - 28; ++x) ramp.insert(At(legend, x, barY + 14));
    EXPECT_GT(ramp.size(), 100u);
    EXPECT_FALSE(ramp.contains(kWhite));
    EXPECT_FALSE(ramp.contains(kDark));
}

TEST(PreviewLegend, NamesWhatItIsOf) {
    auto const draw = [](Subject const& subject, std::string const& of) {
        Picture const legend = Draw(subject).GetColours().DrawLegend(of);
        return std::vector<uint8_t>(
            legend.GetPixels(), legend.GetPixels() + 3 * legend.GetWidth() * legend.GetHeight());
    };
    auto const one = draw(kRamp, "spot 1001");
    EXPECT_NE(draw(kRamp, "spot 1002"), one);
    Subject other = kRamp;
    other.map.name = "other";
    EXPECT_NE(draw(other, "spot 1001"), one);
    other = kRamp;
    other.map.units = "length";
    EXPECT_NE(draw(other, "spot 1001"), one);
}

TEST(PreviewLegend, HasNoBarWhereItWouldMeanNothing) {
    auto const heightOf = [](RangeKind range, int numChannels, double value) {
        return Draw({MakeTraits(range, numChannels), 8, 8, [=](int, int, int) { return value; }})
            .GetColours()
            .DrawLegend("spot")
            .GetHeight();
    };
    int const withBar = Draw(kRamp).GetColours().DrawLegend("spot").GetHeight();
    EXPECT_LT(heightOf(RangeKind::UnitVector, 3, 0.5), withBar);
    EXPECT_LT(heightOf(RangeKind::Line, 3, 0.5), withBar);
    EXPECT_LT(heightOf(RangeKind::Flow, 2, 0.5), withBar);
    EXPECT_LT(heightOf(RangeKind::Positive, 1, 3.0), withBar);  // one value: it is written
}

// -------- ranges

TEST(PreviewRange, ReadsWhatItWrites) {
    for (char const* text : {"p1", "full", "asinh", "-1,1", "0.25,1e+30", "-2.5,-1"})
        EXPECT_EQ(PreviewRange::Parse(text).GetText(), text);
}

TEST(PreviewRange, RefusesWhatIsNoRange) {
    for (char const* text : {"", "p2", "Full", "1", "1,", ",1", "1,1", "2,1", "a,b", "1,2,3",
                             "nan,1", "0,inf", "1 ,2"}) {
        EXPECT_EQ(test::CodeOf([&] { PreviewRange::Parse(text); }), ErrorCode::BadOption) << text;
    }
}

}  // namespace
}  // namespace limn
