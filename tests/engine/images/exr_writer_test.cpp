// SPDX-License-Identifier: Apache-2.0
#include "engine/images/exr_writer.h"

#include <filesystem>

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfTiledInputFile.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/exr_level.h"
#include "support/files.h"

namespace limn {
namespace {

using namespace engine;  // what is tested here is all of one namespace

struct WriterCase {
    ExrCompression compression;
    std::vector<char> isHalf;  // per channel
    bool hasMips;
};
std::vector<char> const kFloats{}, kHalves{1, 1, 1}, kMixed{1, 0, 1};

class ExrWriterAs : public testing::TestWithParam<WriterCase> {};
INSTANTIATE_TEST_SUITE_P(Kinds, ExrWriterAs,
                         testing::Values(WriterCase{ExrCompression::Zip, kHalves, false},
                                         WriterCase{ExrCompression::Zip, kFloats, true},
                                         WriterCase{ExrCompression::Zip, kMixed, true},
                                         WriterCase{ExrCompression::Zips, kFloats, false},
                                         WriterCase{ExrCompression::None, kHalves, true},
                                         WriterCase{ExrCompression::Rle, kHalves, false},
                                         WriterCase{ExrCompression::Piz, kFloats, true},
                                         WriterCase{ExrCompression::Piz, kMixed, true},
                                         WriterCase{ExrCompression::Dwaa, kHalves, false}));

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
    test::TemporaryFolder const folder;
    std::string const path = folder / "a.exr";
    {
        ExrWriter writer(path, spec);
        EXPECT_FALSE(std::filesystem::exists(path));  // not before it is complete
        for (int level = 0; level < spec.GetNumLevels(); ++level) WriteLevel(writer, spec, level);
        writer.Seal({-0.5f, 2.0f})->Commit();
    }
    Imf::TiledInputFile input(path.c_str());
    EXPECT_EQ(input.numLevels(), spec.GetNumLevels());
    EXPECT_EQ(input.header().lineOrder(), Imf::RANDOM_Y);
    auto const findTolerance = [&](size_t channel) {
        if (spec.compression == ExrCompression::Dwaa) return 0.02;
        return spec.IsHalf(channel) ? 1e-3 : 0.0;
    };
    for (int level = 0; level < spec.GetNumLevels(); ++level) {
        int const w = input.levelWidth(level);
        std::vector<float> const pixels = test::ReadLevel(input, level, spec.channels);
        for (size_t i = 0; i < pixels.size(); ++i) {
            int const pixel = static_cast<int>(i / 3), c = static_cast<int>(i % 3);
            ASSERT_NEAR(pixels[i], ValueAt(level, c, pixel % w, pixel / w), findTolerance(i % 3));
        }
    }
    auto const attributes = ReadExrAttributes(path, "limn:");
    ASSERT_EQ(attributes.size(), 2u);
    EXPECT_EQ(attributes[0], std::pair(std::string("limn:map"), std::string("test")));
    EXPECT_EQ(attributes[1].first, "limn:sha256");
    EXPECT_EQ(CheckSeal(path), (ValueRange{-0.5f, 2.0f}));
}

TEST(ExrWriter, LeavesNothingWhenItIsAbandoned) {
    test::TemporaryFolder const folder;
    ExrSpec spec;
    spec.width = spec.height = 64;
    spec.channels = {"Y"};
    {
        ExrWriter writer(folder / "a.exr", spec);
        std::vector<float> const plane(64 * 64, 0.5f);
        float const* const tile = plane.data();
        writer.Write(writer.Pack(0, 0, 0, &tile, 64));
        EXPECT_EQ(folder.List().size(), 1u);
    }
    EXPECT_TRUE(folder.List().empty());
}

TEST(ExrWriter, RefusesTilesThatThereAreNotAndWantsAllThatThereAre) {
    test::TemporaryFolder const folder;
    ExrSpec spec;
    spec.width = spec.height = 100;
    spec.channels = {"Y"};
    std::string const path = folder / "a.exr";
    ExrWriter writer(path, spec);
    struct Tile {
        int level, x, y;
    };
    for (Tile const& tile : {Tile{3, 0, 0}, {-1, 0, 0}, {0, 2, 0}, {0, 0, 2}, {0, -1, 0}}) {
        EXPECT_EQ(test::RefusalOf([&] { writer.PackEmpty(tile.level, tile.x, tile.y); }),
                  fmt::format("'{}': there is no tile {} {} of level {}; level 0 has 2 x 2, and "
                              "levels are 0 to 0",
                              path, tile.x, tile.y, tile.level));
    }
    for (int tile = 0; tile < 3; ++tile) writer.Write(writer.PackEmpty(0, tile % 2, tile / 2));
    EXPECT_EQ(
        test::RefusalOf([&] { writer.Seal({}); }),
        fmt::format("'{}' lacks 1 of its 4 tiles; all are written before it is sealed", path));
    writer.Write(writer.PackEmpty(0, 1, 1));
    writer.Seal({})->Commit();
    EXPECT_TRUE(CheckSeal(path));
}

TEST(ExrWriter, RefusesImagesWithoutTexelsAndKindsOfOtherChannels) {
    test::TemporaryFolder const folder;
    auto const codeOf = [&](ExrSpec const& spec) {
        return test::CodeOf([&] { ExrWriter(folder / "a.exr", spec); });
    };
    EXPECT_EQ(codeOf({.width = 0, .height = 64, .channels = {"Y"}}), ErrorCode::BadOption);
    EXPECT_EQ(codeOf({.width = 64, .height = 64, .channels = {"X", "Y"}, .isHalf = {1}}),
              ErrorCode::BadOption);
    EXPECT_TRUE(folder.List().empty());
}

}  // namespace
}  // namespace limn
