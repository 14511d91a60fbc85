// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace limn::engine {

/// At most 32 bits, the first in the lowest place.
struct Bits {
    uint32_t value = 0, count = 0;

    /// These, and then others; 32 together.
    constexpr Bits Then(Bits next) const {
        return {value | next.value << count, count + next.count};
    }
};

/// Writes bits as deflate has them, the first in a byte's lowest place.
class BitWriter {
public:
    static constexpr size_t kSlack = 8;  ///< bytes behind the last that may be written over

    explicit BitWriter(uint8_t* to) : _to(to) {}

    /// At most 56 together.
    void Put(Bits first, Bits second = {}) {
        _pending |= (first.value | uint64_t{second.value} << first.count) << _numPending;
        _numPending += first.count + second.count;
        std::memcpy(_to, &_pending, sizeof _pending);  // little-endian, as the kernels' CPUs are
        _to += _numPending >> 3;
        _pending >>= _numPending & ~7u;
        _numPending &= 7;
    }

    /// Fills the last byte with zeros.
    ///
    /// \return where the next one goes
    uint8_t* Finish() {
        Put({0, (8 - _numPending) & 7});
        return _to;
    }

private:
    uint8_t* _to;
    uint64_t _pending = 0;
    unsigned _numPending = 0;
};

}  // namespace limn::engine
