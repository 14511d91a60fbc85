// SPDX-License-Identifier: Apache-2.0
#include "engine/images/deflate/tile_deflate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include <libdeflate.h>

#include "engine/images/deflate/bit_writer.h"
#include "eval/kernels/dispatch.h"

namespace limn::engine {

namespace {

constexpr size_t kMaxDistance = 32768;  // of deflate
constexpr size_t kLeastSplit = 4096;    // bytes; below it a second code does not pay for itself
constexpr size_t kFrameSize = 2 + 4;    // bytes of zlib's header and checksum

/// Rising. What a tile is too small for becomes 1.
void ChooseDistances(size_t numBytes, size_t rowSize,
                     size_t (&distances)[MatchJob::kNumDistances]) {
    // Those which, of all within 18 bytes of a multiple of the row, make maps of normals,
    // positions, curvatures and directions smallest.
    auto const row = static_cast<ptrdiff_t>(rowSize);
    std::array<ptrdiff_t, MatchJob::kNumDistances> const wanted{
        1,       2,   3,       4,       row - 5, row - 4,     row - 3, row - 2,
        row - 1, row, row + 1, row + 2, row + 3, 2 * row - 1, 2 * row, 2 * row + 1};
    auto const most = static_cast<ptrdiff_t>(std::min(numBytes, kMaxDistance));
    std::transform(wanted.begin(), wanted.end(), distances, [&](ptrdiff_t distance) {
        return static_cast<size_t>(distance < 1 || distance > most ? 1 : distance);
    });
    std::sort(std::begin(distances), std::end(distances));
}

struct Match {
    size_t length;
    uint32_t where;  ///< the distances at which it is found
};

/// What Matches says of a place and, if that is its longest, how far it goes on.
inline Match FollowMatch(Matches const& matches, size_t position) {
    size_t length = matches.lengths[position];
    uint32_t where = matches.where[position];
    if (length < Matches::kLongest) return {length, where};
    // Steps of kLongest while they are to be had, then single bytes.
    for (; length + Matches::kLongest <= kMaxMatch; length += Matches::kLongest) {
        size_t const i = position + length;
        uint32_t const next =
            matches.lengths[i] == Matches::kLongest ? where & matches.where[i] : 0;
        if (next == 0) break;
        where = next;
    }
    for (; length < kMaxMatch; ++length) {
        uint32_t const next = where & matches.equal[position + length];
        if (next == 0) break;
        where = next;
    }
    return {length, where};
}

/// The tokens of the places from `begin` to `end`. The last one may go on beyond.
BlockTokens Parse(uint8_t const* bytes, Matches const& matches, size_t begin, size_t end,
                  Token* to) {
    BlockTokens block;
    Token* next = to;
    size_t position = begin;
    while (position < end) {
        auto const [length, where] = FollowMatch(matches, position);
        auto const number = static_cast<uint32_t>(std::countr_zero(where | 1u << kNoDistance));
        uint32_t const symbol = length < kMinMatch ? bytes[position] : GetSymbol(length);
        *next++ = {static_cast<uint16_t>(symbol), static_cast<uint16_t>(number)};
        ++block.symbolCounts[symbol];
        ++block.distanceCounts[number];
        position += length;
    }
    block.tokens = {to, next};
    block.end = position;
    return block;
}

}  // namespace

std::span<uint8_t> TileDeflate::Prepare(size_t numBytes, size_t rowSize) {
    ChooseDistances(numBytes, rowSize, _job.distances);
    size_t const numBefore = _job.distances[MatchJob::kNumDistances - 1],
                 size = numBytes + MatchJob::kMargin;
    if (_buffer.size() < numBefore + size) _buffer.resize(numBefore + size);
    _job.bytes = _buffer.data() + numBefore;
    _job.numBytes = numBytes;
    return {_buffer.data() + numBefore, numBytes};
}

Matches TileDeflate::FindMatches() {
    size_t const size = _job.numBytes + MatchJob::kMargin;
    if (_lengths.size() < size) {
        _lengths.resize(size);
        _where.resize(size);
        _equal.resize(size);
    }
    Matches const matches{_lengths.data(), _where.data(), _equal.data()};
    eval::GetKernel<MatchKernel>().find(_job, matches);
    return matches;
}

size_t TileDeflate::Compress(std::span<uint8_t> to) {
    Matches const matches = FindMatches();
    size_t const numBytes = _job.numBytes, split = numBytes < kLeastSplit ? numBytes : numBytes / 2;
    if (_tokens.size() < numBytes) _tokens.resize(numBytes);
    BlockTokens const lowTokens = Parse(_job.bytes, matches, 0, split, _tokens.data());
    BlockTokens const highTokens = Parse(_job.bytes, matches, lowTokens.end, numBytes,
                                         _tokens.data() + lowTokens.tokens.size());
    DeflateBlock const low(lowTokens, _job.distances);
    std::optional<DeflateBlock> high;
    if (!highTokens.tokens.empty()) high.emplace(highTokens, _job.distances);

    size_t const numBits = low.GetNumBits() + (high ? high->GetNumBits() : 0);
    if (kFrameSize + (numBits + 7) / 8 + BitWriter::kSlack > to.size()) return 0;
    to[0] = 0x78;  // deflate, at most 32768 back
    to[1] = 0x01;  // by a fast compressor
    BitWriter writer(to.data() + 2);
    low.Write(!high, writer);
    if (high) high->Write(true, writer);
    uint8_t* end = writer.Finish();
    uint32_t const checksum = libdeflate_adler32(1, _job.bytes, numBytes);
    for (int shift = 24; shift >= 0; shift -= 8) *end++ = static_cast<uint8_t>(checksum >> shift);
    return static_cast<size_t>(end - to.data());
}

}  // namespace limn::engine
