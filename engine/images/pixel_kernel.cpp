// SPDX-License-Identifier: Apache-2.0
#include "engine/images/pixel_kernel.h"

#include <array>

#include "eval/kernels/instruction_set.h"

namespace limn::engine {

#define LIMN_DECLARE_KERNEL(name)                                                  \
    namespace name {                                                               \
    size_t ConvertToHalf(float const*, size_t, uint16_t*, size_t, size_t, size_t); \
    void FindNearest(int32_t const*, int32_t*, size_t, int);                       \
    void FindRange(float const*, uint8_t const*, size_t, float*, float*);          \
    void SplitAndPredict(uint16_t const*, size_t, uint8_t*, uint8_t*);             \
    }
LIMN_DECLARE_KERNEL(sse2)
LIMN_DECLARE_KERNEL(avx2)
LIMN_DECLARE_KERNEL(avx512)
#undef LIMN_DECLARE_KERNEL

namespace {

size_t Chosen() {
    return static_cast<size_t>(eval::GetInstructionSet());
}

}  // namespace

size_t ConvertToHalf(float const* from, size_t fromStride, uint16_t* to, size_t toStride,
                     size_t width, size_t height) {
    constexpr std::array kKernels{sse2::ConvertToHalf, avx2::ConvertToHalf, avx512::ConvertToHalf};
    return kKernels[Chosen()](from, fromStride, to, toStride, width, height);
}

void FindNearest(int32_t const* dy, int32_t* best, size_t count, int radius) {
    constexpr std::array kKernels{sse2::FindNearest, avx2::FindNearest, avx512::FindNearest};
    kKernels[Chosen()](dy, best, count, radius);
}

void FindRange(float const* values, uint8_t const* covered, size_t count, float* low, float* high) {
    constexpr std::array kKernels{sse2::FindRange, avx2::FindRange, avx512::FindRange};
    kKernels[Chosen()](values, covered, count, low, high);
}

void SplitAndPredict(uint16_t const* words, size_t count, uint8_t* scratch, uint8_t* bytes) {
    constexpr std::array kKernels{sse2::SplitAndPredict, avx2::SplitAndPredict,
                                  avx512::SplitAndPredict};
    kKernels[Chosen()](words, count, scratch, bytes);
}

}  // namespace limn::engine
