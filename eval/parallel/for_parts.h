// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "far_ext/types.h"

namespace limn::eval {

/// Calls work(first, last) for parts of [begin, end): shared out to TBB's threads, or at once where
/// the whole is no larger than `grain` and not worth sharing.
template <class Work>
void ForParts(Index begin, Index end, Index grain, Work const& work) {
    if (end - begin <= grain) {
        if (begin < end) work(begin, end);
        return;
    }
    tbb::parallel_for(tbb::blocked_range<Index>(begin, end, static_cast<std::size_t>(grain)),
                      [&](auto const& range) { work(range.begin(), range.end()); });
}

}  // namespace limn::eval
