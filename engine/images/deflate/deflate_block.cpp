// SPDX-License-Identifier: Apache-2.0
#include "engine/images/deflate/deflate_block.h"

#include <algorithm>
#include <bit>

namespace limn::engine {

namespace {

constexpr size_t kEndCode = 256, kFirstLengthCode = 257;

/// How a length or a distance is written: a code that stands for several, and which of them.
struct RangeCode {
    size_t code;
    Bits extra;
};

/// Below 2^(kept + 1) each number has a code; above that the leading bit's place and the `kept`
/// bits behind it make one.
constexpr RangeCode FindRangeCode(uint32_t number, uint32_t kept) {
    auto const width = static_cast<uint32_t>(std::bit_width(number));
    uint32_t const numExtra = width > kept + 1 ? width - kept - 1 : 0;
    return {(numExtra << kept) + (number >> numExtra), {number & ((1u << numExtra) - 1), numExtra}};
}

constexpr RangeCode FindLengthCode(uint32_t length) {
    if (length == kMaxMatch) return {kFirstLengthCode + 28, {}};
    RangeCode range = FindRangeCode(length - kMinMatch, 2);
    range.code += kFirstLengthCode;
    return range;
}

constexpr RangeCode FindDistanceCode(size_t distance) {
    return FindRangeCode(static_cast<uint32_t>(distance - 1), 1);
}

constexpr std::array<RangeCode, kMaxMatch - kMinMatch + 1> kLengthCodes = [] {
    std::array<RangeCode, kMaxMatch - kMinMatch + 1> codes;
    for (uint32_t i = 0; i < codes.size(); ++i) codes[i] = FindLengthCode(kMinMatch + i);
    return codes;
}();
static_assert(kLengthCodes[255 - kMinMatch].code == 284 &&
              kLengthCodes[255 - kMinMatch].extra.value == 28);
static_assert(FindDistanceCode(32768).code == 29 && FindDistanceCode(5).code == 4);

template <class Counts, class Lengths>
size_t CountBits(Counts const& counts, Lengths const& lengths) {
    size_t bits = 0;
    for (size_t i = 0; i < counts.size(); ++i) bits += size_t{counts[i]} * lengths[i];
    return bits;
}

/// Code lengths as deflate writes them: symbols of an alphabet of 19, with repetitions.
struct LengthSymbols {
    struct Entry {
        uint8_t symbol;
        Bits extra;
    };
    std::array<Entry, 320> entries;
    size_t size = 0;
    std::array<uint32_t, 19> counts{};

    void Add(uint8_t symbol, Bits extra = {}) {
        entries[size++] = {symbol, extra};
        ++counts[symbol];
    }
    void AddZeros(uint32_t count) {
        if (count < 11)
            Add(17, {count - 3, 3});
        else
            Add(18, {count - 11, 7});
    }
};

LengthSymbols FindLengthSymbols(std::span<uint8_t const> lengths) {
    LengthSymbols symbols;
    for (size_t i = 0; i < lengths.size();) {
        uint32_t run = 1;
        while (i + run < lengths.size() && lengths[i + run] == lengths[i]) ++run;
        if (lengths[i] == 0 && run >= 3) {
            run = std::min(run, 138u);
            symbols.AddZeros(run);
        } else if (lengths[i] != 0 && run >= 4) {
            run = std::min(run, 7u);
            symbols.Add(lengths[i]);
            symbols.Add(16, {run - 4, 2});
        } else {
            run = 1;
            symbols.Add(lengths[i]);
        }
        i += run;
    }
    return symbols;
}

template <class Lengths>
uint32_t FindSize(Lengths const& lengths, size_t least) {
    auto size = static_cast<uint32_t>(lengths.size());
    while (size > least && lengths[size - 1] == 0) --size;
    return size;
}

}  // namespace

DeflateBlock::DeflateBlock(BlockTokens const& tokens, std::span<size_t const> distances)
    : _distances(distances), _tokens(tokens.tokens) {
    Counts const counts = CountCodes(tokens);
    auto const countBits = [&](Lengths const& lengths) {
        return CountBits(counts.literals, lengths.literals) +
               CountBits(counts.distances, lengths.distances) + counts.numExtraBits;
    };
    Lengths own;
    FindCodeLengths(counts.literals, 15, std::span(own.literals).first(kNumLiteralCodes));
    FindCodeLengths(counts.distances, 15, own.distances);
    Lengths const fixed = GetFixedLengths();

    MakeHeader(own);
    size_t const numFixedBits = 3 + countBits(fixed);
    _numBits = 1 + countBits(own);
    for (size_t i = 0; i < _headerSize; ++i) _numBits += _header[i].count;
    if (_numBits < numFixedBits) {
        MakeWords(own);
        return;
    }
    _numBits = numFixedBits;
    _header[0] = {1, 2};
    _headerSize = 1;
    MakeWords(fixed);
}

DeflateBlock::Lengths DeflateBlock::GetFixedLengths() {
    Lengths fixed;
    std::fill_n(fixed.literals.begin(), 144, uint8_t{8});
    std::fill_n(fixed.literals.begin() + 144, 112, uint8_t{9});
    std::fill_n(fixed.literals.begin() + 256, 24, uint8_t{7});
    std::fill_n(fixed.literals.begin() + 280, 8, uint8_t{8});
    fixed.distances.fill(5);
    return fixed;
}

DeflateBlock::Counts DeflateBlock::CountCodes(BlockTokens const& tokens) const {
    Counts counts;
    std::copy_n(tokens.symbolCounts.begin(), kFirstLengthSymbol, counts.literals.begin());
    for (size_t i = 0; i < kLengthCodes.size(); ++i) {
        uint32_t const count = tokens.symbolCounts[kFirstLengthSymbol + i];
        counts.literals[kLengthCodes[i].code] += count;
        counts.numExtraBits += size_t{count} * kLengthCodes[i].extra.count;
    }
    counts.literals[kEndCode] = 1;
    for (size_t k = 0; k < _distances.size(); ++k) {
        RangeCode const range = FindDistanceCode(_distances[k]);
        counts.distances[range.code] += tokens.distanceCounts[k];
        counts.numExtraBits += size_t{tokens.distanceCounts[k]} * range.extra.count;
    }
    return counts;
}

void DeflateBlock::MakeHeader(Lengths const& lengths) {
    // The order in which the lengths of the lengths' own code are written: rare ones last.
    constexpr std::array<uint8_t, kNumLengthCodes> kOrder{16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                          11, 4,  12, 3, 13, 2, 14, 1, 15};
    uint32_t const numLiterals = FindSize(lengths.literals, kFirstLengthCode),
                   numDistances = FindSize(lengths.distances, 1);
    std::array<uint8_t, kNumLiteralCodes + kNumDistanceCodes> both;
    std::copy_n(lengths.literals.begin(), numLiterals, both.begin());
    std::copy_n(lengths.distances.begin(), numDistances, both.begin() + numLiterals);
    LengthSymbols const symbols =
        FindLengthSymbols(std::span(both).first(numLiterals + numDistances));

    std::array<uint8_t, kNumLengthCodes> codeLengths, ordered;
    std::array<uint16_t, kNumLengthCodes> words;
    FindCodeLengths(symbols.counts, 7, codeLengths);
    AssignCodeWords(codeLengths, words);
    for (size_t i = 0; i < kOrder.size(); ++i) ordered[i] = codeLengths[kOrder[i]];
    uint32_t const numOrdered = FindSize(ordered, 4);

    _headerSize = 0;
    auto const put = [&](Bits bits) { _header[_headerSize++] = bits; };
    put({2, 2});
    put(Bits{numLiterals - 257, 5}.Then({numDistances - 1, 5}).Then({numOrdered - 4, 4}));
    for (size_t i = 0; i < numOrdered; ++i) put({ordered[i], 3});
    for (size_t i = 0; i < symbols.size; ++i) {
        auto const& [symbol, extra] = symbols.entries[i];
        put(Bits{words[symbol], codeLengths[symbol]}.Then(extra));
    }
}

void DeflateBlock::MakeWords(Lengths const& lengths) {
    std::array<uint16_t, kMaxSymbols> literals;
    std::array<uint16_t, kNumDistanceCodes> distances;
    AssignCodeWords(lengths.literals, literals);
    AssignCodeWords(lengths.distances, distances);
    for (size_t i = 0; i < kFirstLengthSymbol; ++i)
        _symbolWords[i] = {literals[i], lengths.literals[i]};
    for (size_t i = 0; i < kLengthCodes.size(); ++i) {
        auto const& [code, extra] = kLengthCodes[i];
        _symbolWords[kFirstLengthSymbol + i] =
            Bits{literals[code], lengths.literals[code]}.Then(extra);
    }
    for (size_t k = 0; k < _distances.size(); ++k) {
        auto const [code, extra] = FindDistanceCode(_distances[k]);
        _distanceWords[k] = Bits{distances[code], lengths.distances[code]}.Then(extra);
    }
    _distanceWords[kNoDistance] = {};
    _endWord = {literals[kEndCode], lengths.literals[kEndCode]};
}

void DeflateBlock::Write(bool isLast, BitWriter& writer) const {
    BitWriter local = writer;  // which stays in registers
    local.Put({isLast ? 1u : 0u, 1});
    for (size_t i = 0; i < _headerSize; ++i) local.Put(_header[i]);
    for (Token const token : _tokens)
        local.Put(_symbolWords[token.symbol], _distanceWords[token.distance]);
    local.Put(_endWord);
    writer = local;
}

}  // namespace limn::engine
