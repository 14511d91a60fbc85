// SPDX-License-Identifier: Apache-2.0
#include "engine/images/deflate/tile_deflate.h"

#include <algorithm>
#include <random>
#include <string>

#include <Imath/half.h>
#include <OpenEXR/ImfTiledInputFile.h>
#include <gtest/gtest.h>

#include "engine/images/pixel_kernel.h"
#include "eval/kernels/dispatch.h"
#include "support/exr_level.h"
#include "support/inflate.h"
#include "support/instruction_sets.h"

namespace limn {
namespace {

using engine::TileDeflate;
using Bytes = std::vector<uint8_t>;

/// Empty where `room` bytes are too few.
Bytes Deflate(TileDeflate& deflate, Bytes const& bytes, size_t rowSize, size_t room) {
    std::copy(bytes.begin(), bytes.end(), deflate.Prepare(bytes.size(), rowSize).begin());
    Bytes to(room, 0xa5);
    to.resize(deflate.Compress(to));
    return to;
}

/// Bytes alike in every row and half but for some, so that there are matches at all distances.
Bytes MakeRows(size_t size, size_t rowSize, unsigned oneChangesIn) {
    std::minstd_rand random(static_cast<unsigned>(size));
    Bytes bytes(size);
    for (size_t i = 0; i < size; ++i) {
        bytes[i] = i < rowSize || random() % oneChangesIn == 0
                       ? static_cast<uint8_t>(128 + random() % 7)
                       : bytes[i - rowSize];
    }
    return bytes;
}

struct ByteKind {
    char const* name;
    Bytes (*make)(size_t size, size_t rowSize);
};
class TileDeflateOf : public testing::TestWithParam<ByteKind> {};
INSTANTIATE_TEST_SUITE_P(
    Bytes, TileDeflateOf,
    testing::Values(
        ByteKind{"Constant", [](size_t size, size_t) { return Bytes(size, 128); }},
        ByteKind{"Gradient",
                 [](size_t size, size_t) {
                     Bytes bytes(size);
                     for (size_t i = 0; i < size; ++i) bytes[i] = static_cast<uint8_t>(i * 3);
                     return bytes;
                 }},
        ByteKind{"Random",
                 [](size_t size, size_t) {
                     std::minstd_rand random(static_cast<unsigned>(size));
                     Bytes bytes(size);
                     for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random() >> 8);
                     return bytes;
                 }},
        ByteKind{"Rows", [](size_t size, size_t rowSize) { return MakeRows(size, rowSize, 5); }},
        ByteKind{"LongRows",
                 [](size_t size, size_t rowSize) { return MakeRows(size, rowSize, 200); }}),
    [](auto const& kind) { return kind.param.name; });

void ExpectRoundTrip(TileDeflate& deflate, Bytes const& bytes, size_t rowSize) {
    Bytes const stream = Deflate(deflate, bytes, rowSize, 2 * bytes.size() + 100);
    ASSERT_FALSE(stream.empty());
    ASSERT_EQ(test::InflateByZlib(stream, bytes.size()), bytes);
    ASSERT_EQ(test::InflateByLibdeflate(stream, bytes.size()), bytes);
}

// At the least sizes a row is longer than the tile, or as short as the near distances.
TEST_P(TileDeflateOf, ComesBackThroughZlibAndLibdeflate) {
    TileDeflate deflate;
    for (size_t size = 1; size <= 200; ++size) {
        for (size_t rowSize : {size_t{1}, size_t{7}, size / 2 + 1, size}) {
            SCOPED_TRACE(testing::Message() << size << " bytes, rows of " << rowSize);
            ExpectRoundTrip(deflate, GetParam().make(size, rowSize), rowSize);
        }
    }
    // Widths of tiles by channels; the last ones have rows that deflate's distances do not reach.
    for (size_t rowSize : {1u, 2u, 3u, 5u, 63u, 64u, 3u * 37u, 192u, 256u, 40u * 64u, 300u * 64u}) {
        size_t const size = 2 * rowSize * (rowSize < 256 ? 64 : 5);
        SCOPED_TRACE(testing::Message() << size << " bytes, rows of " << rowSize);
        ExpectRoundTrip(deflate, GetParam().make(size, rowSize), rowSize);
    }
}

TEST_P(TileDeflateOf, IsTheSameForEveryInstructionSet) {
    for (size_t size : {1u, 200u, 959u, 960u, 961u, 8192u, 24576u}) {
        Bytes const bytes = GetParam().make(size, 192);
        Bytes first;
        test::ForEachInstructionSet([&](eval::InstructionSet set) {
            TileDeflate deflate;
            Bytes const stream = Deflate(deflate, bytes, 192, 2 * size + 100);
            if (first.empty()) first = stream;
            EXPECT_EQ(stream, first) << size << " bytes, " << eval::GetName(set);
        });
    }
}

// What a compressor held before must not be seen in what it makes next.
TEST_P(TileDeflateOf, IsTheSameWhateverCameBefore) {
    TileDeflate used;
    Deflate(used, MakeRows(30000, 100, 9), 100, 60000);
    for (size_t size : {1u, 200u, 960u, 8192u}) {
        Bytes const bytes = GetParam().make(size, 64);
        TileDeflate fresh;
        EXPECT_EQ(Deflate(used, bytes, 64, 2 * size + 100),
                  Deflate(fresh, bytes, 64, 2 * size + 100));
    }
}

TEST_P(TileDeflateOf, StaysWithinTheRoomThereIs) {
    TileDeflate deflate;
    for (size_t size : {1u, 50u, 200u, 8192u}) {
        Bytes const bytes = GetParam().make(size, 64);
        size_t const least =
            Deflate(deflate, bytes, 64, 2 * size + 100).size() + engine::BitWriter::kSlack;
        std::copy(bytes.begin(), bytes.end(), deflate.Prepare(size, 64).begin());
        Bytes to(least + 20, 0xa5);
        EXPECT_EQ(deflate.Compress(std::span(to).first(least - 1)), 0u);
        EXPECT_EQ(to, Bytes(least + 20, 0xa5));
        EXPECT_EQ(deflate.Compress(std::span(to).first(least)) + engine::BitWriter::kSlack, least);
        EXPECT_TRUE(std::all_of(to.begin() + least, to.end(), [](uint8_t b) { return b == 0xa5; }));
    }
}

/// A map that limn has baked, 64 x 64, as half floats in the form in which EXR's ZIP has them.
Bytes MakeBakedTile(std::string const& map, std::vector<std::string> const& channels) {
    Imf::TiledInputFile file(
        (std::string(LIMN_TEST_DATA) + "/../golden/spot." + map + ".exr").c_str());
    std::vector<float> const pixels = test::ReadLevel(file, 0, channels);
    std::vector<uint16_t> words;
    for (size_t row = 0; row < 64; ++row) {
        for (size_t c = 0; c < channels.size(); ++c) {
            for (size_t column = 0; column < 64; ++column) {
                float const value = pixels[(row * 64 + column) * channels.size() + c];
                words.push_back(Imath::half(std::clamp(value, -65504.0f, 65504.0f)).bits());
            }
        }
    }
    Bytes scratch(2 * words.size()), bytes(2 * words.size());
    eval::GetKernel<engine::PixelKernel>().splitAndPredict(words.data(), words.size(),
                                                           scratch.data(), bytes.data());
    return bytes;
}

class TileDeflateOfBaked
    : public testing::TestWithParam<std::pair<char const*, std::vector<std::string>>> {};
INSTANTIATE_TEST_SUITE_P(
    Maps, TileDeflateOfBaked,
    testing::Values(std::pair{"normal", std::vector<std::string>{"B", "G", "R"}},
                    std::pair{"curvature",
                              std::vector<std::string>{"gaussian", "k1", "k2", "mean"}},
                    std::pair{"stretch", std::vector<std::string>{"Y"}}),
    [](auto const& map) { return map.param.first; });

TEST_P(TileDeflateOfBaked, ComesBackAndIsAboutAsSmallAsByZlib) {
    auto const& [map, channels] = GetParam();
    Bytes const bytes = MakeBakedTile(map, channels);
    TileDeflate deflate;
    ExpectRoundTrip(deflate, bytes, 64 * channels.size());
    size_t const size = Deflate(deflate, bytes, 64 * channels.size(), bytes.size()).size();
    Bytes peer(compressBound(bytes.size()));
    uLongf peerSize = peer.size();
    ASSERT_EQ(compress2(peer.data(), &peerSize, bytes.data(), bytes.size(), 4), Z_OK);
    EXPECT_LE(static_cast<double>(size), 1.05 * static_cast<double>(peerSize));
}

}  // namespace
}  // namespace limn
