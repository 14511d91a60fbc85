// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

namespace limn::test {

/// Calls work() where what it shares out goes to so many threads, however many cores there are.
template <class Work>
void WithThreads(int numThreads, Work const& work) {
    tbb::global_control const limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(numThreads));
    tbb::task_arena arena(numThreads);
    arena.execute(work);
}

}  // namespace limn::test
