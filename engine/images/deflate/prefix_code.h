// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace limn::engine {

inline constexpr size_t kMaxSymbols = 288;  ///< of deflate's largest alphabet

/// Lengths of the prefix code that writes symbols in the fewest bits: Huffman's, where words that
/// would be longer than `maxLength` are shortened at the cost of the next. Of equal counts the
/// first symbol has the longer word, so that there is one answer.
///
/// \param counts   at most kMaxSymbols, of which 2^maxLength may differ from 0
/// \param lengths  as many; 0 for what does not occur. Decoders want all words of a code to have a
///                 meaning: where fewer than two symbols occur, some others get a word, too
void FindCodeLengths(std::span<uint32_t const> counts, int maxLength, std::span<uint8_t> lengths);

/// The words that deflate gives to symbols whose code has these lengths (at most 15), with the bit
/// that comes first in the lowest place. 0 where the length is 0.
void AssignCodeWords(std::span<uint8_t const> lengths, std::span<uint16_t> words);

}  // namespace limn::engine
