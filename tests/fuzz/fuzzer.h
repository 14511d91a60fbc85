// SPDX-License-Identifier: Apache-2.0
//
// What a fuzzer of this folder is: a program that takes bytes and ends, loudly, where something
// that limn promises does not hold. With libFuzzer it makes up its bytes, with replay.cpp it reads
// them from files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include <tbb/global_control.h>

#include "engine/scene/job.h"
#include "far_ext/error.h"

extern "C" int LLVMFuzzerTestOneInput(uint8_t const* data, size_t size);

namespace limn::fuzz {

/// Ends the program, which is a find, unless the promise holds.
inline void Require(bool holds, char const* promise) {
    if (holds) return;
    std::fprintf(stderr, "does not hold: %s\n", promise);
    std::abort();
}

/// Runs `work`, which may refuse or stop, but in no other way than limn says. True if it did not.
template <class Work>
bool Succeeds(Work const& work) {
    try {
        work();
        return true;
    } catch (Error const& error) {
        Require(error.what()[0] != '\0', "an error has a message");
        return false;
    } catch (engine::Stopped const&) {
        return false;
    }
}

/// Runs `work`, which must not refuse.
template <class Work>
auto MustSucceed(char const* promise, Work const& work) {
    try {
        return work();
    } catch (Error const& error) {
        std::fprintf(stderr, "refused: %s\n", error.what());
        Require(false, promise);
        throw;
    }
}

/// The inputs are small, and what threads do is for other tests: one does most per second, and what
/// it found it finds again.
inline void UseOneThread() {
    static tbb::global_control const oneThread(tbb::global_control::max_allowed_parallelism, 1);
}

}  // namespace limn::fuzz
