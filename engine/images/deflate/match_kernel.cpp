// SPDX-License-Identifier: Apache-2.0
//
// Integers only; what a kernel may do, see eval/kernels/dispatch.h.

#include "engine/images/deflate/match_kernel.h"

namespace limn::engine {

namespace {

constexpr size_t kLanes = 4 * LIMN_KERNEL_LANES;  // bytes of a register
typedef uint8_t Lanes __attribute__((vector_size(kLanes)));

// Places are looked at in blocks that stay in the nearest cache. What is compared reaches far
// enough for a match at the last place, and for the one behind it.
constexpr size_t kBlock = 960, kCompared = kBlock + 64;
static_assert(kCompared % kLanes == 0 && kCompared <= MatchJob::kMargin);

/// Bit k of these: is found at distance k, and at distance 8 + k.
struct Masks {
    alignas(64) uint8_t low[kCompared + kLanes], high[kCompared + kLanes];
};

inline Lanes Load(uint8_t const* from) {
    Lanes lanes;
    __builtin_memcpy(&lanes, from, sizeof lanes);
    return lanes;
}
inline void Store(uint8_t* to, Lanes lanes) {
    __builtin_memcpy(to, &lanes, sizeof lanes);
}

inline void Compare(uint8_t const* bytes, size_t const* distances, uint8_t* masks) {
    for (size_t i = 0; i < kCompared; i += kLanes) {
        Lanes const here = Load(bytes + i);
        Lanes mask{};
#pragma GCC unroll 8
        for (int k = 0; k < 8; ++k) {
            mask |= (Lanes)(here == Load(bytes + i - distances[k])) & static_cast<uint8_t>(1u << k);
        }
        Store(masks + i, mask);
    }
}

/// Takes back what was compared with bytes before the first, or of those behind the last.
void KeepInside(MatchJob const& job, size_t begin, Masks* equal) {
    for (int k = 0; k < MatchJob::kNumDistances; ++k) {
        uint8_t* const masks = k < 8 ? equal->low : equal->high;
        auto const others = static_cast<uint8_t>(~(1u << (k & 7)));
        for (size_t i = 0; i < kCompared && begin + i < job.distances[k]; ++i) masks[i] &= others;
    }
    for (size_t i = kCompared; i > 0 && begin + i > job.numBytes; --i)
        equal->low[i - 1] = equal->high[i - 1] = 0;
}

/// Length and distances of the longest matches. `equal` must end with zeros.
inline void FindLongest(Masks const& equal, Masks* where, uint8_t* lengths) {
    for (size_t i = 0; i < kCompared; i += kLanes) {
        Lanes low = Load(equal.low + i), high = Load(equal.high + i);
        Lanes lastLow = low, lastHigh = high;
        Lanes length{};
        length -= (Lanes)((low | high) != 0);
#pragma GCC unroll 8
        for (size_t step = 1; step < Matches::kLongest; ++step) {
            low &= Load(equal.low + i + step);
            high &= Load(equal.high + i + step);
            Lanes const goesOn = (Lanes)((low | high) != 0);
            lastLow = goesOn ? low : lastLow;
            lastHigh = goesOn ? high : lastHigh;
            length -= goesOn;
        }
        Store(where->low + i, lastLow);
        Store(where->high + i, lastHigh);
        Store(lengths + i, length);
    }
}

/// Decides, place by place, between a match and a literal.
inline void Choose(uint8_t const* found, Masks* where, uint8_t* lengths) {
    for (size_t i = 0; i < kBlock; ++i) {
        bool const isLater = (found[i + 1] > found[i]) & (found[i] < Matches::kLongest);
        bool const isLiteral = (found[i] < Matches::kShortest) | isLater;
        lengths[i] = isLiteral ? uint8_t{1} : found[i];
        where->low[i] = isLiteral ? uint8_t{0} : where->low[i];
        where->high[i] = isLiteral ? uint8_t{0} : where->high[i];
    }
}

inline void Join(Masks const& masks, uint16_t* both) {
    for (size_t i = 0; i < kBlock; ++i)
        both[i] = static_cast<uint16_t>(masks.low[i] | masks.high[i] << 8);
}

void FindMatches(MatchJob const& job, Matches const& matches) {
    Masks equal{}, where;
    uint8_t lengths[kCompared];
    for (size_t begin = 0; begin <= job.numBytes; begin += kBlock) {
        Compare(job.bytes + begin, job.distances, equal.low);
        Compare(job.bytes + begin, job.distances + 8, equal.high);
        if (begin < job.distances[MatchJob::kNumDistances - 1] || begin + kCompared > job.numBytes)
            KeepInside(job, begin, &equal);
        Join(equal, matches.equal + begin);
        FindLongest(equal, &where, lengths);
        Choose(lengths, &where, matches.lengths + begin);
        Join(where, matches.where + begin);
    }
}

}  // namespace

constinit MatchKernel const MatchKernel::LIMN_KERNEL = {.find = FindMatches};

}  // namespace limn::engine
