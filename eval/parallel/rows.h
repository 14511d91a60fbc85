// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <type_traits>
#include <vector>

#include <tbb/parallel_for.h>

#include "far_ext/types.h"

namespace limn::eval {

// Rows (of vertices, faces, places ...) in blocks that follow each other, shared out to the calling
// arena's threads. The blocks depend on the numbers of rows alone, never on threads: what is added
// up within blocks and then block after block has the same bits for any number of threads. It
// would have others with blocks of another size, or in pairs, as TBB's deterministic reduction
// adds.
//
// Where nothing is added and each row is much work, tbb::parallel_for over the rows says it all.

/// Rows of a block: some microseconds of light work.
inline constexpr Index kRowsPerBlock = 2048;

constexpr Index CountBlocks(Index numRows, Index rowsPerBlock) {
    return numRows / rowsPerBlock + (numRows % rowsPerBlock > 0 ? 1 : 0);
}

/// Calls work(begin, end) for the blocks of rows 0 to numRows - 1.
template <class Work>
void ForEachBlock(Index numRows, Index rowsPerBlock, Work const& work) {
    auto const run = [&](Index block) {
        Index const begin = block * rowsPerBlock;
        work(begin, begin + std::min(rowsPerBlock, numRows - begin));
    };
    Index const numBlocks = CountBlocks(numRows, rowsPerBlock);
    if (numBlocks == 1)
        run(0);  // not worth a task
    else
        tbb::parallel_for(Index{0}, numBlocks, run);
}

/// The same; returns what work(begin, end) returned, block after block.
template <class Work>
auto MapBlocks(Index numRows, Index rowsPerBlock, Work const& work) {
    using Result = decltype(work(Index{}, Index{}));
    static_assert(!std::is_same_v<Result, bool>, "threads cannot write bits of one vector");
    std::vector<Result> results(static_cast<std::size_t>(CountBlocks(numRows, rowsPerBlock)));
    ForEachBlock(numRows, rowsPerBlock, [&](Index begin, Index end) {
        results[static_cast<std::size_t>(begin / rowsPerBlock)] = work(begin, end);
    });
    return results;
}

/// Calls run(row) for rows 0 to numRows - 1.
template <class Run>
void ForEachRow(Index numRows, Run const& run) {
    ForEachBlock(numRows, kRowsPerBlock, [&](Index begin, Index end) {
        for (Index row = begin; row < end; ++row) run(row);
    });
}

/// The sum of term(row), an Eigen array, over rows 0 to numRows - 1: added within blocks of
/// kRowsPerBlock, then block after block.
template <class Term>
auto SumRows(Index numRows, Term const& term) {
    using Sum = decltype(term(Index{}));
    auto const partials = MapBlocks(numRows, kRowsPerBlock, [&](Index begin, Index end) {
        Sum sum = Sum::Zero();
        for (Index row = begin; row < end; ++row) sum += term(row);
        return sum;
    });
    Sum total = Sum::Zero();
    for (Sum const& partial : partials) total += partial;
    return total;
}

}  // namespace limn::eval
