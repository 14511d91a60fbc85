// SPDX-License-Identifier: Apache-2.0
#include "engine/images/value_histogram.h"

#include <algorithm>
#include <bit>

namespace limn::engine {

namespace {

/// A float's bits so that they have its order: those of negative ones are turned round.
uint32_t ToOrdered(float value) {
    uint32_t const bits = std::bit_cast<uint32_t>(value);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

uint32_t FindBin(float value) {
    return ToOrdered(value) >> 16;
}

float FromOrdered(uint32_t ordered) {
    return std::bit_cast<float>(ordered & 0x80000000u ? ordered & 0x7fffffffu : ~ordered);
}

}  // namespace

void ValueHistogram::Add(float value) {
    ++_bins[FindBin(value)];
    ++_count;
    _min = std::min(_min, value);
    _max = std::max(_max, value);
}

float ValueHistogram::FindQuantile(double share) const {
    if (_count == 0) return 0.0f;
    auto const rank = static_cast<uint64_t>(share * static_cast<double>(_count - 1));
    uint64_t before = 0;
    uint32_t bin = 0;
    while (before + _bins[bin] <= rank) before += _bins[bin++];
    if (bin == FindBin(_min)) return _min;
    return bin == FindBin(_max) ? _max : FromOrdered(bin << 16 | 0x8000u);
}

}  // namespace limn::engine
