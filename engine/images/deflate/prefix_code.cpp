// SPDX-License-Identifier: Apache-2.0
#include "engine/images/deflate/prefix_code.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace limn::engine {

namespace {

constexpr int kMaxCodeLength = 15;
using LengthCounts = std::array<uint32_t, kMaxCodeLength + 1>;

/// Symbols that occur, rarest first.
struct RankedSymbols {
    struct Entry {
        uint16_t count, symbol;
    };
    std::array<Entry, kMaxSymbols + 1> entries;
    size_t size = 0;
};

/// One pass of sorting by digits: by byte `digit` of the counts, equal ones as they stood.
void SortByDigit(RankedSymbols const& from, int digit, RankedSymbols& to) {
    auto const findDigit = [&](auto const& entry) { return entry.count >> (8 * digit) & 0xff; };
    std::array<uint16_t, 257> starts{};
    for (size_t i = 0; i < from.size; ++i) ++starts[findDigit(from.entries[i]) + 1];
    for (size_t d = 1; d < starts.size(); ++d) starts[d] += starts[d - 1];
    for (size_t i = 0; i < from.size; ++i)
        to.entries[starts[findDigit(from.entries[i])]++] = from.entries[i];
    to.size = from.size;
}

RankedSymbols RankSymbols(std::span<uint32_t const> counts) {
    uint32_t const most = *std::max_element(counts.begin(), counts.end());
    int const shift =
        std::max(0, static_cast<int>(std::bit_width(most)) - 16);  // no code notices the rest
    RankedSymbols ranked, sorted;
    for (size_t symbol = 0; symbol < counts.size(); ++symbol) {
        uint32_t const count = std::max(counts[symbol] >> shift, 1u);
        ranked.entries[ranked.size] = {static_cast<uint16_t>(count), static_cast<uint16_t>(symbol)};
        ranked.size += counts[symbol] != 0 ? 1 : 0;
    }
    SortByDigit(ranked, 0, sorted);
    if (most < 256) return sorted;
    SortByDigit(sorted, 1, ranked);
    return ranked;
}

/// How many words of Huffman's code have each length; longer ones count as `maxLength`.
LengthCounts CountLengths(RankedSymbols const& symbols, int maxLength) {
    // Two queues, both rising: the leaves, and the nodes in the order in which they are made.
    constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
    size_t const numLeaves = symbols.size, numNodes = numLeaves - 1;
    std::array<uint32_t, kMaxSymbols + 1> leaves, nodes;
    std::array<uint16_t, 2 * kMaxSymbols> parents;  // of the leaves, then of the nodes
    for (size_t i = 0; i < numLeaves; ++i) leaves[i] = symbols.entries[i].count;
    leaves[numLeaves] = kNone;
    std::fill_n(nodes.begin(), numNodes + 1, kNone);
    size_t leaf = 0, node = 0;
    for (size_t made = 0; made < numNodes; ++made) {
        uint32_t sum = 0;
        for (int child = 0; child < 2; ++child) {
            bool const isLeaf = leaves[leaf] <= nodes[node];
            sum += isLeaf ? leaves[leaf] : nodes[node];
            parents[isLeaf ? leaf : numLeaves + node] = static_cast<uint16_t>(made);
            leaf += isLeaf ? 1 : 0;
            node += isLeaf ? 0 : 1;
        }
        nodes[made] = sum;
    }

    LengthCounts counts{};
    std::array<uint16_t, kMaxSymbols> depths;
    depths[numNodes - 1] = 0;
    for (size_t i = numNodes - 1; i-- > 0;)
        depths[i] = static_cast<uint16_t>(depths[parents[numLeaves + i]] + 1);
    for (size_t i = 0; i < numLeaves; ++i)
        ++counts[static_cast<size_t>(std::min(depths[parents[i]] + 1, maxLength))];
    return counts;
}

/// Where words were cut the code has too many: each step lengthens one of the longest that can be,
/// which makes room for one of those that were cut beside it.
void MakeRoom(LengthCounts& counts, int maxLength) {
    uint32_t used = 0;  // in units of the longest words
    for (int length = 1; length <= maxLength; ++length)
        used += counts[static_cast<size_t>(length)] << (maxLength - length);
    for (; used > uint32_t{1} << maxLength; --used) {
        auto length = static_cast<size_t>(maxLength - 1);
        while (counts[length] == 0) --length;
        --counts[length];
        counts[length + 1] += 2;
        --counts[static_cast<size_t>(maxLength)];
    }
}

uint16_t ReverseBits(uint32_t word, int numBits) {
    word = (word & 0x5555u) << 1 | (word >> 1 & 0x5555u);
    word = (word & 0x3333u) << 2 | (word >> 2 & 0x3333u);
    word = (word & 0x0f0fu) << 4 | (word >> 4 & 0x0f0fu);
    word = (word & 0x00ffu) << 8 | (word >> 8 & 0x00ffu);
    return static_cast<uint16_t>(word >> (16 - numBits));
}

}  // namespace

void FindCodeLengths(std::span<uint32_t const> counts, int maxLength, std::span<uint8_t> lengths) {
    std::fill(lengths.begin(), lengths.end(), uint8_t{0});
    RankedSymbols const symbols = RankSymbols(counts);
    if (symbols.size < 2) {
        size_t const symbol = symbols.size == 1 ? symbols.entries[0].symbol : 0;
        lengths[symbol] = lengths[symbol == 0 ? 1 : 0] = 1;
        return;
    }
    LengthCounts lengthCounts = CountLengths(symbols, maxLength);
    MakeRoom(lengthCounts, maxLength);
    size_t next = 0;
    for (size_t length = lengthCounts.size(); length-- > 1;) {
        for (uint32_t i = 0; i < lengthCounts[length]; ++i)
            lengths[symbols.entries[next++].symbol] = static_cast<uint8_t>(length);
    }
}

void AssignCodeWords(std::span<uint8_t const> lengths, std::span<uint16_t> words) {
    LengthCounts counts{}, next{};
    for (uint8_t const length : lengths) ++counts[length];
    counts[0] = 0;
    for (size_t length = 1; length < next.size(); ++length)
        next[length] = (next[length - 1] + counts[length - 1]) << 1;
    for (size_t symbol = 0; symbol < lengths.size(); ++symbol) {
        uint8_t const length = lengths[symbol];
        words[symbol] = ReverseBits(next[length]++, length);
    }
}

}  // namespace limn::engine
