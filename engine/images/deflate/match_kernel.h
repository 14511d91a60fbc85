// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace limn::engine {

/// Bytes to be compared with themselves, a few distances back.
struct MatchJob {
    static constexpr int kNumDistances = 16;
    static constexpr size_t kMargin = 1024;  ///< bytes behind the last that are read, or written

    /// Readable, whatever is there, from the largest distance before the first byte to kMargin
    /// behind the last.
    uint8_t const* bytes;
    size_t numBytes;
    size_t distances[kNumDistances];  ///< at least 1, rising; one may repeat
};

/// What repeats, place by place; bit k speaks of distances[k]. Room for MatchJob::kMargin places
/// more than there are bytes, which get zeros in `equal`.
struct Matches {
    static constexpr int kShortest = 3;
    static constexpr int kLongest = 8;  ///< as they stand here; they may go on

    /// The length of a match that begins here, or 1 for a literal: where there is none, and where
    /// one byte later a longer one begins.
    uint8_t* lengths;
    uint16_t* where;  ///< the distances at which that match is found; none for a literal
    uint16_t* equal;  ///< the distances at which this one byte is found
};

/// The search for matches: comparisons of bytes, see eval/kernels/dispatch.h.
struct MatchKernel {
    void (*find)(MatchJob const& job, Matches const& matches);

    static MatchKernel const sse2, avx2, avx512;
};

}  // namespace limn::engine
