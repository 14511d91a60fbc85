// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include <tbb/parallel_for.h>

#include "far_ext/types.h"

namespace limn::eval {

/// Calls work(begin, end) for the rows 0 to count in chunks of fixed size, on all threads, and
/// returns what it returned, chunk by chunk: summed up in that order, results do not depend on the
/// number of threads.
template <class Work>
auto MapChunks(Index count, Work const& work) {
    constexpr Index kChunk = 4096;
    Index const numChunks = (count + kChunk - 1) / kChunk;
    std::vector<decltype(work(Index(), Index()))> results(static_cast<size_t>(numChunks));
    tbb::parallel_for(Index(0), numChunks, [&](Index chunk) {
        results[static_cast<size_t>(chunk)] =
            work(chunk * kChunk, std::min(count, (chunk + 1) * kChunk));
    });
    return results;
}

/// The same for work that returns nothing.
template <class Work>
void ForEachChunk(Index count, Work const& work) {
    MapChunks(count, [&](Index begin, Index end) {
        work(begin, end);
        return char();
    });
}

/// Calls f.operator()<Length>() with a length known when compiling: 1 to 4.
template <class F>
void WithLength(int length, F const& f) {
    switch (length) {
        case 1:
            return f.template operator()<1>();
        case 2:
            return f.template operator()<2>();
        case 3:
            return f.template operator()<3>();
        default:
            return f.template operator()<4>();
    }
}

}  // namespace limn::eval
