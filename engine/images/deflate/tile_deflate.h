// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/images/deflate/deflate_block.h"
#include "engine/images/deflate/match_kernel.h"

namespace limn::engine {

/// Compresses tiles of half floats as zlib streams (RFC 1950), for any decoder.
///
/// Matches are sought at 16 distances only: a few bytes back, and about one and two rows up, which
/// is where smooth maps repeat. They are found by comparing the tile with itself, all distances at
/// once. So there is no hash table, and nothing that depends on the CPU: the same bytes everywhere.
/// The two halves of a tile, its low bytes and its high bytes, have a code each.
///
/// One per thread.
class TileDeflate {
public:
    /// Room for a tile, to be filled before Compress; what was there is lost.
    ///
    /// \param numBytes  at least 1
    /// \param rowSize   bytes of one row of one half: as many as the row has half floats
    std::span<uint8_t> Prepare(size_t numBytes, size_t rowSize);

    /// \param to  room for the result and BitWriter::kSlack bytes more
    /// \return    the result's size; 0 if it does not fit, and nothing is written
    size_t Compress(std::span<uint8_t> to);

private:
    Matches FindMatches();

    std::vector<uint8_t> _buffer, _lengths;
    std::vector<uint16_t> _where, _equal;
    std::vector<Token> _tokens;
    MatchJob _job{};
};

}  // namespace limn::engine
