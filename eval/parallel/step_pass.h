// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "eval/parallel/rows.h"

namespace limn::eval {

// Several steps of an iteration in one pass over the rows. A step reads its rows' neighbours in the
// vector that the step before wrote, and may overwrite the one before that. Steps therefore run at
// a distance: what a step reads is done, and what it writes is read no more. The same bits as one
// step after the other, and what belongs to the rows comes from memory once for all of them.

/// Blocks of kRowsPerBlock rows that each step works on at once.
inline constexpr Index kBlocksAbreast = 4;

/// Blocks from one step to the next: those that are worked on at once, and those that neighbours
/// reach into.
///
/// \param bandwidth  largest distance between a row and one of its neighbours
inline Index FindStepDistance(Index bandwidth) {
    return kBlocksAbreast + 1 + bandwidth / kRowsPerBlock;
}

/// How many steps are best taken together: several where the rows do not stay in the cache, and
/// steps fit behind each other.
inline int CountStepsPerPass(Index numRows, Index bandwidth) {
    constexpr int kSteps = 4;
    return numRows / kRowsPerBlock >= 2 * kSteps * FindStepDistance(bandwidth) ? kSteps : 1;
}

/// Calls work(step, begin, end) for all blocks of rows and all steps, by the arena's threads.
template <class Work>
void RunStepsInOnePass(Index numSteps, Index numRows, Index bandwidth, Work const& work) {
    Index const numBlocks = CountBlocks(numRows, kRowsPerBlock),
                distance = FindStepDistance(bandwidth);
    for (Index front = 0; front < numBlocks + distance * (numSteps - 1); front += kBlocksAbreast) {
        tbb::parallel_for(Index{0}, numSteps * kBlocksAbreast, [&](Index task) {
            Index const step = task / kBlocksAbreast,
                        block = front - distance * step + task % kBlocksAbreast;
            if (block < 0 || block >= numBlocks) return;
            Index const begin = block * kRowsPerBlock;
            work(step, begin, begin + std::min(kRowsPerBlock, numRows - begin));
        });
    }
}

}  // namespace limn::eval
