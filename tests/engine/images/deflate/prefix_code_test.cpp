// SPDX-License-Identifier: Apache-2.0
#include "engine/images/deflate/prefix_code.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace limn {
namespace {

using Counts = std::vector<uint32_t>;

std::vector<uint8_t> FindLengths(Counts const& counts, int maxLength) {
    std::vector<uint8_t> lengths(counts.size(), 99);
    engine::FindCodeLengths(counts, maxLength, lengths);
    return lengths;
}

/// Of a code's words, in units of a word of 15 bits: 2^15 if they fill it.
int CountUsed(std::vector<uint8_t> const& lengths) {
    int used = 0;
    for (uint8_t const length : lengths) used += length == 0 ? 0 : 1 << (15 - length);
    return used;
}

uint64_t CountBits(Counts const& counts, std::vector<uint8_t> const& lengths) {
    return std::inner_product(counts.begin(), counts.end(), lengths.begin(), uint64_t{0});
}

/// By Huffman's own words: the two least become one, which costs their sum.
uint64_t FindLeastBits(Counts const& counts) {
    std::priority_queue<uint64_t, std::vector<uint64_t>, std::greater<>> queue;
    for (uint32_t const count : counts)
        if (count != 0) queue.push(count);
    uint64_t bits = 0;
    while (queue.size() > 1) {
        uint64_t sum = queue.top();
        queue.pop();
        sum += queue.top();
        queue.pop();
        bits += sum;
        queue.push(sum);
    }
    return bits;
}

// A word of 16 bits needs counts that add up to Fibonacci's 2584 at least; these make at most 287 *
// 9 = 2583.
TEST(FindCodeLengths, GivesHuffmansCostWithinItsLimit) {
    std::minstd_rand random;
    for (int run = 0; run < 100; ++run) {
        Counts counts(2 + random() % 286);
        for (uint32_t& count : counts) count = static_cast<uint32_t>(random() % 10);
        counts.front() = counts.back() = 1;
        std::vector<uint8_t> const lengths = FindLengths(counts, 15);
        EXPECT_EQ(CountBits(counts, lengths), FindLeastBits(counts)) << run;
        EXPECT_EQ(CountUsed(lengths), 1 << 15) << run;
    }
}

// Fibonacci's numbers make the longest words there can be.
TEST(FindCodeLengths, KeepsWithinItsLimitAndFillsTheCode) {
    Counts fibonacci{1, 1};
    while (fibonacci.size() < 40) fibonacci.push_back(fibonacci.back() + fibonacci.end()[-2]);
    for (int limit : {6, 7, 14, 15}) {
        std::vector<uint8_t> const lengths = FindLengths(fibonacci, limit);
        EXPECT_EQ(*std::max_element(lengths.begin(), lengths.end()), limit);
        EXPECT_GT(*std::min_element(lengths.begin(), lengths.end()), 0);
        EXPECT_EQ(CountUsed(lengths), 1 << 15);
        EXPECT_TRUE(std::is_sorted(lengths.rbegin(), lengths.rend()));  // the rarer, the longer
    }
}

TEST(FindCodeLengths, FillsTheCodeWhereFewSymbolsOccur) {
    for (Counts const& counts : {Counts{0, 0, 0}, Counts{0, 7, 0}, Counts{7, 0, 0}}) {
        std::vector<uint8_t> const lengths = FindLengths(counts, 15);
        EXPECT_EQ(CountUsed(lengths), 1 << 15);
        for (size_t i = 0; i < counts.size(); ++i) EXPECT_TRUE(counts[i] == 0 || lengths[i] == 1);
    }
}

// RFC 1951, 3.2.2, has this example.
TEST(AssignCodeWords, GivesTheWordsOfDeflate) {
    std::vector<uint8_t> const lengths{3, 3, 3, 3, 3, 2, 4, 4};
    std::vector<std::string> const expected{"010", "011", "100",  "101",
                                            "110", "00",  "1110", "1111"};
    std::vector<uint16_t> words(lengths.size());
    engine::AssignCodeWords(lengths, words);
    for (size_t i = 0; i < words.size(); ++i) {
        std::string word;
        for (int bit = 0; bit < lengths[i]; ++bit) word += words[i] >> bit & 1 ? '1' : '0';
        EXPECT_EQ(word, expected[i]);
    }
}

TEST(AssignCodeWords, GivesNothingToWhatDoesNotOccur) {
    std::vector<uint8_t> const lengths{1, 0, 1, 0};
    std::vector<uint16_t> words(lengths.size(), 99);
    engine::AssignCodeWords(lengths, words);
    EXPECT_EQ(words, (std::vector<uint16_t>{0, 0, 1, 0}));
}

}  // namespace
}  // namespace limn
