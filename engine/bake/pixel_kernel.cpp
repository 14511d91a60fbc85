#include "engine/bake/pixel_kernel.h"

#include <bit>

// One clone per instruction set, chosen by the loader. Only integer operations and plain loops.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LIMN_PER_TARGET  // the loader runs before the sanitizer does
#else
#define LIMN_PER_TARGET \
    __attribute__((target_clones("default", "avx2", "arch=x86-64-v4"), optimize("O3")))
#endif

namespace limn::engine {

LIMN_PER_TARGET
size_t ConvertToHalf(float const* from, uint16_t* to, size_t count) {
    uint32_t numClamped = 0;
    size_t total = 0;
    for (size_t start = 0; start < count; start += 1 << 20) {
        size_t const end = start + (1 << 20) < count ? start + (1 << 20) : count;
        numClamped = 0;
        for (size_t i = start; i < end; ++i) {
            uint32_t const bits = __builtin_bit_cast(uint32_t, from[i]);
            uint32_t const sign = (bits >> 16) & 0x8000u;
            uint32_t magnitude = bits & 0x7fffffffu;
            bool const isBeyond = magnitude > 0x477fe000u;  // 65504
            numClamped += isBeyond ? 1u : 0u;
            magnitude = isBeyond ? 0x477fe000u : magnitude;
            // Normal: rebias the exponent and round the 13 dropped bits to even.
            uint32_t const normal = (magnitude + 0xfffu + ((magnitude >> 13) & 1u) - 0x38000000u) >> 13;
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

LIMN_PER_TARGET
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

}  // namespace limn::engine
