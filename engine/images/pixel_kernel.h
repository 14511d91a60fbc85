// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace limn::engine {

inline constexpr int32_t kFarRow = 127;

/// The loops over pixels that decide how fast a file is written. Integer arithmetic: the same bytes
/// on every CPU, see eval/kernels/dispatch.h.
struct PixelKernel {
    /// A block of 32-bit floats to 16-bit, rounding to nearest even. Finite values beyond +-65504
    /// are clamped.
    ///
    /// \param fromStride, toStride  elements from row to row
    /// \return how many were clamped
    size_t (*convertToHalf)(float const* from, size_t fromStride, uint16_t* to, size_t toStride,
                            size_t width, size_t height);

    /// Extends [low, high] by the values of covered texels.
    void (*findRange)(float const* values, uint8_t const* covered, size_t count, float* low,
                      float* high);

    /// For every column the smaller of best[x] and, over offsets dx in [-radius, radius],
    ///     (dx^2 + dy[x + dx]^2) * 2^16 + (dy[x + dx] + 128) * 2^8 + (dx + 128).
    ///
    /// \param dy    at most 64 in magnitude, or kFarRow; readable from -radius to count + radius -
    /// 1
    /// \param best  the least key so far
    void (*findNearest)(int32_t const* dy, int32_t* best, size_t count, int radius);

    /// The first half of OpenEXR's ZIP scheme: bytes at even places, then bytes at odd places, each
    /// replaced by its difference to the byte before it, plus 128.
    ///
    /// \param words  `count` 16-bit words, little-endian: the pixels' bytes
    /// \param bytes  2 * count bytes
    void (*splitAndPredict)(uint16_t const* words, size_t count, uint8_t* scratch, uint8_t* bytes);

    static PixelKernel const sse2, avx2, avx512;
};

}  // namespace limn::engine
