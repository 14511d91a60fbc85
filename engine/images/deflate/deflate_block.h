// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/images/deflate/bit_writer.h"
#include "engine/images/deflate/match_kernel.h"
#include "engine/images/deflate/prefix_code.h"

namespace limn::engine {

inline constexpr uint32_t kMinMatch = 3, kMaxMatch = 258;         ///< of deflate
inline constexpr uint32_t kNoDistance = MatchJob::kNumDistances;  ///< of literals

/// Symbols of tokens: a byte is its own, lengths of matches follow.
inline constexpr uint32_t kFirstLengthSymbol = 256;
inline constexpr size_t kNumTokenSymbols = kFirstLengthSymbol + kMaxMatch - kMinMatch + 1;
constexpr uint32_t GetSymbol(size_t length) {
    return static_cast<uint32_t>(length) + kFirstLengthSymbol - kMinMatch;
}

/// A literal or a match: a symbol and the number of a distance.
struct Token {
    uint16_t symbol, distance;
};

/// The tokens of a block, and how often symbols and distances occur in them.
struct BlockTokens {
    std::span<Token const> tokens;
    size_t end = 0;  ///< the place behind what they stand for
    std::array<uint32_t, kNumTokenSymbols> symbolCounts{};
    std::array<uint32_t, kNoDistance + 1> distanceCounts{};
};

/// A block of deflate (RFC 1951), in the code that suits its tokens or in the fixed one, whichever
/// is smaller.
class DeflateBlock {
public:
    /// \param tokens     stay where they are until the block is written
    /// \param distances  MatchJob::kNumDistances, from 1 to 32768; stay, too
    DeflateBlock(BlockTokens const& tokens, std::span<size_t const> distances);

    /// Of the whole block as it will be written.
    size_t GetNumBits() const { return _numBits; }

    void Write(bool isLast, BitWriter& writer) const;

private:
    static constexpr size_t kNumLiteralCodes = 286, kNumDistanceCodes = 30, kNumLengthCodes = 19;
    static constexpr size_t kMaxHeader = 3 + kNumLengthCodes + kNumLiteralCodes + kNumDistanceCodes;

    struct Counts {
        std::array<uint32_t, kNumLiteralCodes> literals{};  ///< and lengths, and the block's end
        std::array<uint32_t, kNumDistanceCodes> distances{};
        size_t numExtraBits = 0;
    };
    struct Lengths {
        std::array<uint8_t, kMaxSymbols> literals{};
        std::array<uint8_t, kNumDistanceCodes> distances{};
    };

    static Lengths GetFixedLengths();
    Counts CountCodes(BlockTokens const& tokens) const;
    void MakeHeader(Lengths const& lengths);
    void MakeWords(Lengths const& lengths);

    std::span<size_t const> _distances;
    std::span<Token const> _tokens;
    size_t _numBits = 0;
    std::array<Bits, kMaxHeader> _header;  ///< what follows the bit for the last block
    size_t _headerSize = 0;
    std::array<Bits, kNumTokenSymbols> _symbolWords;
    std::array<Bits, kNoDistance + 1> _distanceWords;
    Bits _endWord;
};

}  // namespace limn::engine
