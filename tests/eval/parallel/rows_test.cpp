// SPDX-License-Identifier: Apache-2.0
#include "eval/parallel/rows.h"

#include <cmath>
#include <utility>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "support/threads.h"

namespace limn {
namespace {

using eval::kRowsPerBlock;
using Block = std::pair<Index, Index>;

constexpr int kNumsThreads[] = {1, 2, 5};
constexpr Index kManyRows = 20 * kRowsPerBlock + 7;

/// Terms of such unlike sizes that their sum's bits tell in which order they were added.
Eigen::Array4d MakeTerm(Index row) {
    double const x = 0.1 * row;
    return {std::sin(x), std::exp(std::sin(x)), 1.0 / (1.0 + row), 0.0};
}

std::vector<Block> ListBlocks(Index numRows, Index rowsPerBlock) {
    return eval::MapBlocks(numRows, rowsPerBlock,
                           [](Index begin, Index end) { return Block(begin, end); });
}

TEST(Rows, BlocksFollowEachOtherAndTheLastMayBeShorter) {
    EXPECT_EQ(ListBlocks(10, 4), (std::vector<Block>{{0, 4}, {4, 8}, {8, 10}}));
    EXPECT_EQ(ListBlocks(8, 4), (std::vector<Block>{{0, 4}, {4, 8}}));
    EXPECT_EQ(ListBlocks(3, 4), (std::vector<Block>{{0, 3}}));
    EXPECT_EQ(ListBlocks(0, 4), (std::vector<Block>{}));
}

TEST(Rows, BlocksReachTheLargestIndex) {
    constexpr Index kMost = 2147483647, kHalf = 1 << 30;
    EXPECT_EQ(ListBlocks(kMost, kHalf), (std::vector<Block>{{0, kHalf}, {kHalf, kMost}}));
}

TEST(Rows, BlocksDoNotDependOnThreads) {
    for (int numThreads : kNumsThreads) {
        test::WithThreads(numThreads, [&] {
            auto const blocks = ListBlocks(kManyRows, 64);
            ASSERT_EQ(blocks.size(), static_cast<size_t>(eval::CountBlocks(kManyRows, 64)));
            for (size_t i = 0; i < blocks.size(); ++i)
                ASSERT_EQ(blocks[i].first, static_cast<Index>(64 * i)) << numThreads;
        });
    }
}

TEST(Rows, EachRowRunsOnce) {
    for (int numThreads : kNumsThreads) {
        test::WithThreads(numThreads, [&] {
            for (Index numRows : {0, 1, kRowsPerBlock, kRowsPerBlock + 1, kManyRows}) {
                std::vector<int> counts(static_cast<size_t>(numRows), 0);
                eval::ForEachRow(numRows, [&](Index row) { ++counts[row]; });
                EXPECT_EQ(counts, std::vector<int>(counts.size(), 1)) << numThreads;
            }
        });
    }
}

// The law that solvers' bits rest on: rows within blocks of 2048, then block after block.
TEST(Rows, SumsAreThoseOfOneThreadForAnyNumberOfThreads) {
    Eigen::Array4d expected = Eigen::Array4d::Zero();
    for (Index begin = 0; begin < kManyRows; begin += 2048) {
        Eigen::Array4d ofBlock = Eigen::Array4d::Zero();
        for (Index row = begin; row < std::min(begin + 2048, kManyRows); ++row)
            ofBlock += MakeTerm(row);
        expected += ofBlock;
    }
    for (int numThreads : kNumsThreads) {
        test::WithThreads(numThreads, [&] {
            EXPECT_TRUE((eval::SumRows(kManyRows, MakeTerm) == expected).all()) << numThreads;
        });
    }
}

TEST(Rows, NoRowsSumToZero) {
    EXPECT_TRUE((eval::SumRows(0, MakeTerm) == 0.0).all());
}

}  // namespace
}  // namespace limn
