// SPDX-License-Identifier: Apache-2.0
//
// Integer operations and one float addition; what a kernel may do, see eval/kernels/dispatch.h.

#include "engine/images/pixel_kernel.h"

namespace limn::engine {

namespace {

size_t ConvertToHalf(float const* from, size_t fromStride, uint16_t* to, size_t toStride,
                     size_t width, size_t height) {
    size_t total = 0;
    for (size_t row = 0; row < height; ++row, from += fromStride, to += toStride) {
        uint32_t numClamped = 0;
        for (size_t i = 0; i < width; ++i) {
            uint32_t const bits = __builtin_bit_cast(uint32_t, from[i]);
            uint32_t const sign = (bits >> 16) & 0x8000u;
            uint32_t magnitude = bits & 0x7fffffffu;
            // No pixel is infinite: what half cannot hold becomes its largest number [Bake 4].
            bool const isBeyond = magnitude > 0x477fe000u;  // 65504
            numClamped += isBeyond ? 1u : 0u;
            magnitude = isBeyond ? 0x477fe000u : magnitude;
            // Normal: rebias the exponent and round the 13 dropped bits to even.
            uint32_t const normal =
                (magnitude + 0xfffu + ((magnitude >> 13) & 1u) - 0x38000000u) >> 13;
            // Subnormal: adding 2^-1 makes the FPU shift the mantissa, rounding to even.
            float const shifted = __builtin_bit_cast(float, magnitude) + 0.5f;
            uint32_t const subnormal = __builtin_bit_cast(uint32_t, shifted) - 0x3f000000u;
            uint32_t const half = magnitude < 0x38800000u ? subnormal : normal;
            to[i] = static_cast<uint16_t>(sign | half);
        }
        total += numClamped;
    }
    return total;
}

// A key is the squared distance with dy and dx below it, so that the least key is the nearest texel
// and, of equals, the upper, then the left one: ties need no comparison of their own [Bake 7].
void FindNearest(int32_t const* dy, int32_t* best, size_t count, int radius) {
    for (int dx = -radius; dx <= radius; ++dx) {
        int32_t const* const from = dy + dx;
        int32_t const across = dx * dx * 65536 + dx + 128;
        for (size_t x = 0; x < count; ++x) {
            int32_t const key = from[x] * from[x] * 65536 + (from[x] + 128) * 256 + across;
            best[x] = key < best[x] ? key : best[x];
        }
    }
}

// Least and largest do not depend on the order, so that sixteen may be sought at once [Limit 11].
void FindRange(float const* values, uint8_t const* covered, size_t count, float* low, float* high) {
    constexpr size_t kLanes = 16;
    typedef float Lanes __attribute__((vector_size(4 * kLanes)));
    typedef int32_t Mask __attribute__((vector_size(4 * kLanes)));
    typedef uint8_t Bytes __attribute__((vector_size(kLanes)));
    Lanes least = Lanes{} + *low, most = Lanes{} + *high;
    size_t i = 0;
    for (; i + kLanes <= count; i += kLanes) {
        Lanes value;
        Bytes bytes;
        __builtin_memcpy(&value, values + i, sizeof value);
        __builtin_memcpy(&bytes, covered + i, sizeof bytes);
        Mask const isCovered = __builtin_convertvector(bytes, Mask) != 0;
        least = (isCovered & (value < least)) ? value : least;
        most = (isCovered & (value > most)) ? value : most;
    }
    for (size_t l = 0; l < kLanes; ++l) {
        *low = least[l] < *low ? least[l] : *low;
        *high = most[l] > *high ? most[l] : *high;
    }
    for (; i < count; ++i) {
        if (!covered[i]) continue;
        *low = values[i] < *low ? values[i] : *low;
        *high = values[i] > *high ? values[i] : *high;
    }
}

void SplitAndPredict(uint16_t const* words, size_t count, uint8_t* scratch, uint8_t* bytes) {
    for (size_t i = 0; i < count; ++i) {
        scratch[i] = static_cast<uint8_t>(words[i]);
        scratch[count + i] = static_cast<uint8_t>(words[i] >> 8);
    }
    if (count == 0) return;
    bytes[0] = scratch[0];
    for (size_t i = 1; i < 2 * count; ++i) {
        bytes[i] = static_cast<uint8_t>(scratch[i] - scratch[i - 1] + 128);
    }
}

}  // namespace

constinit PixelKernel const PixelKernel::LIMN_KERNEL = {
    .convertToHalf = ConvertToHalf,
    .findRange = FindRange,
    .findNearest = FindNearest,
    .splitAndPredict = SplitAndPredict,
};

}  // namespace limn::engine
