// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>
#include <tbb/parallel_for.h>

#include "far_ext/types.h"

namespace limn::eval {

/// Three right-hand sides side by side, and a fourth lane that stays 0.
using FloatLanes = Eigen::Array4f;
using DoubleLanes = Eigen::Array4d;

constexpr Index kRowsPerBlock = 2048;

/// Calls run(begin, end, block) for blocks of rows, by the arena's threads. Blocks do not depend on
/// these.
template <class Run>
void ForEachBlock(Index numRows, Run const& run) {
    Index const numBlocks = (numRows + kRowsPerBlock - 1) / kRowsPerBlock;
    auto const runBlock = [&](Index block) {
        run(block * kRowsPerBlock, std::min(numRows, (block + 1) * kRowsPerBlock),
            static_cast<size_t>(block));
    };
    if (numBlocks <= 2) {  // not worth waking anyone
        for (Index block = 0; block < numBlocks; ++block) runBlock(block);
    } else {
        tbb::parallel_for(Index{0}, numBlocks, runBlock);
    }
}

/// Calls run(row) for all rows.
template <class Run>
void ForEachRow(Index numRows, Run const& run) {
    ForEachBlock(numRows, [&](Index begin, Index end, size_t) {
        for (Index row = begin; row < end; ++row) run(row);
    });
}

/// Sum of term(row), added within blocks and then block after block: the same bits whatever the
/// threads.
template <class Term>
DoubleLanes SumRows(Index numRows, Term const& term) {
    std::vector<DoubleLanes> partial(static_cast<size_t>(numRows / kRowsPerBlock + 1),
                                     DoubleLanes::Zero());
    ForEachBlock(numRows, [&](Index begin, Index end, size_t block) {
        DoubleLanes sum = DoubleLanes::Zero();
        for (Index row = begin; row < end; ++row) sum += term(row);
        partial[block] = sum;
    });
    DoubleLanes total = DoubleLanes::Zero();
    for (DoubleLanes const& sum : partial) total += sum;
    return total;
}

}  // namespace limn::eval
