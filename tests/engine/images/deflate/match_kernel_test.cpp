// SPDX-License-Identifier: Apache-2.0
#include "engine/images/deflate/match_kernel.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "eval/kernels/dispatch.h"
#include "support/instruction_sets.h"

namespace limn {
namespace {

using engine::Matches;
using engine::MatchJob;

/// Bytes of few values, in a buffer whose margins hold more of the same.
struct MatchCase {
    MatchCase(size_t numBytes, unsigned numValues) {
        std::minstd_rand random(numValues);
        buffer.resize(kBefore + numBytes + MatchJob::kMargin);
        for (uint8_t& byte : buffer) byte = static_cast<uint8_t>((random() >> 8) % numValues);
        job = {buffer.data() + kBefore,
               numBytes,
               {1, 1, 1, 2, 3, 4, 5, 60, 61, 62, 63, 64, 65, 100, 127, kBefore}};
        lengths.resize(numBytes + MatchJob::kMargin);
        where.resize(lengths.size());
        equal.resize(lengths.size());
    }
    void Find() {
        eval::GetKernel<engine::MatchKernel>().find(job,
                                                    {lengths.data(), where.data(), equal.data()});
    }

    /// By comparing byte by byte: how far the bytes from `i` on are those at distance k, at most 8.
    int FindLength(size_t i, int k) const {
        size_t const distance = job.distances[k];
        int length = 0;
        while (length < Matches::kLongest && i + length < job.numBytes && distance <= i + length &&
               job.bytes[i + length] == job.bytes[i + length - distance])
            ++length;
        return length;
    }
    int FindLongest(size_t i) const {
        int longest = 0;
        for (int k = 0; k < MatchJob::kNumDistances; ++k)
            longest = std::max(longest, FindLength(i, k));
        return longest;
    }

    static constexpr size_t kBefore = 128;
    std::vector<uint8_t> buffer, lengths;
    std::vector<uint16_t> where, equal;
    MatchJob job{};
};

class MatchKernelOn : public testing::TestWithParam<std::pair<size_t, unsigned>> {};
INSTANTIATE_TEST_SUITE_P(Bytes, MatchKernelOn,
                         testing::Values(std::pair{1, 2}, std::pair{9, 1}, std::pair{200, 3},
                                         std::pair{960, 2}, std::pair{1920, 1}, std::pair{2500, 2},
                                         std::pair{2500, 6}));

TEST_P(MatchKernelOn, FindsWhatComparingByteByByteFinds) {
    test::ForEachInstructionSet([](eval::InstructionSet set) {
        MatchCase found(GetParam().first, GetParam().second);
        found.Find();
        for (size_t i = 0; i < found.job.numBytes; ++i) {
            int const longest = found.FindLongest(i);
            bool const isLiteral =
                longest < Matches::kShortest ||
                (longest < Matches::kLongest && found.FindLongest(i + 1) > longest);
            ASSERT_EQ(found.lengths[i], isLiteral ? 1 : longest) << i << " " << eval::GetName(set);
            for (int k = 0; k < MatchJob::kNumDistances; ++k) {
                int const length = found.FindLength(i, k);
                ASSERT_EQ(found.equal[i] >> k & 1, length > 0) << i << " " << k;
                ASSERT_EQ(found.where[i] >> k & 1, !isLiteral && length == longest)
                    << i << " " << k;
            }
        }
        EXPECT_EQ(found.equal[found.job.numBytes], 0);  // no match goes on beyond the end
    });
}

}  // namespace
}  // namespace limn
