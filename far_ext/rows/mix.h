// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace limn::far_ext {

/// A number scattered over 64 bits, for hashes.
inline uint64_t Mix(uint64_t value) {
    value *= 0x9e3779b97f4a7c15u;
    value ^= value >> 29;
    value *= 0xbf58476d1ce4e5b9u;
    return value ^ (value >> 32);
}

}  // namespace limn::far_ext
