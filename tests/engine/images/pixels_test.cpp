// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <random>

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfTiledInputFile.h>
#include <gtest/gtest.h>

#include "engine/bake/dilate.h"
#include "engine/bake/maps/portable_math.h"
#include "engine/bake/mip_chain.h"
#include "engine/images/exr_lookup.h"
#include "engine/images/exr_writer.h"
#include "engine/images/pixel_kernel.h"
#include "eval/kernels/dispatch.h"

namespace limn {
namespace {

namespace fs = std::filesystem;
using namespace engine;  // what is tested here is all of one namespace

std::vector<eval::InstructionSet> SupportedSets() {
    std::vector<eval::InstructionSet> sets;
    auto const before = eval::GetInstructionSet();
    for (auto set :
         {eval::InstructionSet::Sse2, eval::InstructionSet::Avx2, eval::InstructionSet::Avx512}) {
        if (eval::SelectInstructionSet(set)) sets.push_back(set);
    }
    eval::SelectInstructionSet(before);
    return sets;
}

// Imath's own conversion is the reference, over a stride of all floats in the range of half.
TEST(ConvertToHalf, RoundsLikeImath) {
    std::vector<float> values;
    for (uint64_t bits = 0; bits < (1ull << 32); bits += 40503) {
        auto const word = static_cast<uint32_t>(bits);
        float value;
        std::memcpy(&value, &word, sizeof value);
        if (std::isfinite(value) && std::abs(value) <= 65504.0f) values.push_back(value);
    }
    std::vector<uint16_t> halves(values.size());
    for (auto set : SupportedSets()) {
        ASSERT_TRUE(eval::SelectInstructionSet(set));
        EXPECT_EQ(eval::GetKernel<PixelKernel>().convertToHalf(
                      values.data(), values.size(), halves.data(), values.size(), values.size(), 1),
                  0u);
        for (size_t i = 0; i < values.size(); ++i)
            ASSERT_EQ(halves[i], Imath::half(values[i]).bits()) << values[i];
    }
}

TEST(ConvertToHalf, ClampsAndCountsWhatIsBeyondRange) {
    float const values[4] = {1e6f, -7e4f, 65504.0f, 2.0f};
    uint16_t halves[4];
    EXPECT_EQ(eval::GetKernel<PixelKernel>().convertToHalf(values, 4, halves, 4, 4, 1), 2u);
    EXPECT_EQ(halves[0], Imath::half(65504.0f).bits());
    EXPECT_EQ(halves[1], Imath::half(-65504.0f).bits());
}

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

TEST(PortableFunctions, AgreeWithTheLibrary) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> value(-3.0f, 3.0f);
    for (int i = 0; i < 20000; ++i) {
        float const y = value(random), x = value(random);
        ASSERT_NEAR(PortableAtan2(y, x), std::atan2(y, x), 4e-7);
        float const positive = std::exp2(10.0f * y);
        ASSERT_NEAR(PortableLog2(positive), std::log2(positive),
                    2e-6 * (1.0 + std::abs(10.0 * static_cast<double>(y))));
    }
    EXPECT_EQ(PortableAtan2(0.0f, 0.0f), 0.0f);
}

struct WriterCase {
    ExrCompression compression;
    bool isHalf, hasMips;
};
class ExrWriterAs : public testing::TestWithParam<WriterCase> {};
INSTANTIATE_TEST_SUITE_P(Kinds, ExrWriterAs,
                         testing::Values(WriterCase{ExrCompression::Zip, true, false},
                                         WriterCase{ExrCompression::Zip, false, true},
                                         WriterCase{ExrCompression::Zips, false, false},
                                         WriterCase{ExrCompression::None, true, true},
                                         WriterCase{ExrCompression::Rle, true, false},
                                         WriterCase{ExrCompression::Piz, false, true},
                                         WriterCase{ExrCompression::Dwaa, true, false}));

float ValueAt(int level, int c, int x, int y) {
    return 0.25f * static_cast<float>(level + c) + 0.001f * static_cast<float>(x - 2 * y);
}

/// All tiles of a level of three channels.
void WriteLevel(ExrWriter& writer, ExrSpec const& spec, int level) {
    int const w = spec.GetLevelWidth(level), h = spec.GetLevelHeight(level);
    std::vector<std::vector<float>> planes(3);
    for (int c = 0; c < 3; ++c) {
        for (int y = 0; y < h; ++y) {
            for (int x = 0; x < w; ++x)
                planes[static_cast<size_t>(c)].push_back(ValueAt(level, c, x, y));
        }
    }
    for (int ty = 0; ty * 64 < h; ++ty) {
        for (int tx = 0; tx * 64 < w; ++tx) {
            float const* tile[3];
            for (size_t c = 0; c < 3; ++c)
                tile[c] = &planes[c][static_cast<size_t>(ty * 64 * w + tx * 64)];
            writer.Write(writer.Pack(level, tx, ty, tile, static_cast<size_t>(w)));
        }
    }
}

/// By OpenEXR's own reader, R, G and B of one pixel after another.
std::vector<float> ReadLevel(Imf::TiledInputFile& input, int level) {
    int const w = input.levelWidth(level), h = input.levelHeight(level);
    std::vector<float> pixels(static_cast<size_t>(3 * w * h));
    Imf::FrameBuffer buffer;
    char const* const names[3] = {"R", "G", "B"};
    for (size_t c = 0; c < 3; ++c) {
        buffer.insert(names[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels.data() + c),
                                           12, 12 * static_cast<size_t>(w)));
    }
    input.setFrameBuffer(buffer);
    input.readTiles(0, input.numXTiles(level) - 1, 0, input.numYTiles(level) - 1, level);
    return pixels;
}

// What is packed is what OpenEXR's own reader finds, on every level, at sizes that are no multiple
// of a tile.
TEST_P(ExrWriterAs, ReadsBackThroughOpenExr) {
    ExrSpec spec;
    spec.width = 150;
    spec.height = 70;
    spec.isHalf = GetParam().isHalf;
    spec.hasMips = GetParam().hasMips;
    spec.compression = GetParam().compression;
    spec.channels = {"R", "G", "B"};  // the file has them as B, G, R
    spec.attributes = {{"limn:map", "test"}};
    fs::path const path =
        fs::temp_directory_path() / ("limn_pixels_" + std::to_string(::getpid()) + ".exr");
    {
        ExrWriter writer(path.string(), spec);
        EXPECT_FALSE(fs::exists(path));  // not before it is complete
        for (int level = 0; level < spec.GetNumLevels(); ++level) WriteLevel(writer, spec, level);
        writer.Commit();
    }
    Imf::TiledInputFile input(path.c_str());
    EXPECT_EQ(input.numLevels(), spec.GetNumLevels());
    EXPECT_EQ(input.header().lineOrder(), Imf::RANDOM_Y);
    double const tolerance = GetParam().compression == ExrCompression::Dwaa ? 0.02
                             : spec.isHalf                                  ? 1e-3
                                                                            : 0.0;
    for (int level = 0; level < spec.GetNumLevels(); ++level) {
        int const w = input.levelWidth(level);
        std::vector<float> const pixels = ReadLevel(input, level);
        for (size_t i = 0; i < pixels.size(); ++i) {
            int const pixel = static_cast<int>(i / 3), c = static_cast<int>(i % 3);
            ASSERT_NEAR(pixels[i], ValueAt(level, c, pixel % w, pixel / w), tolerance);
        }
    }
    auto const attributes = ReadExrAttributes(path.string(), "limn:");
    ASSERT_EQ(attributes.size(), 1u);
    EXPECT_EQ(attributes[0].second, "test");
    fs::remove(path);
}

TEST(ExrWriter, LeavesNothingWhenItIsAbandoned) {
    fs::path const folder =
        fs::temp_directory_path() / ("limn_abandoned_" + std::to_string(::getpid()));
    fs::create_directory(folder);
    ExrSpec spec;
    spec.width = spec.height = 64;
    spec.channels = {"Y"};
    {
        ExrWriter const writer((folder / "a.exr").string(), spec);
    }
    EXPECT_TRUE(fs::is_empty(folder));
    fs::remove_all(folder);
}

}  // namespace
}  // namespace limn
