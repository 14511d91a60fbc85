// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/inversion_kernel.h"

#include <array>
#include <cstddef>

#include "eval/kernels/instruction_set.h"

namespace limn::eval {

#define LIMN_DECLARE_KERNEL(name)                                                           \
    namespace name {                                                                        \
    void FitInverse(InversionCell&);                                                        \
    void InvertTextureMap(InversionCell const&, double const*, double const*, int, double*, \
                          double*, Whereabouts*);                                           \
    }
LIMN_DECLARE_KERNEL(sse2)
LIMN_DECLARE_KERNEL(avx2)
LIMN_DECLARE_KERNEL(avx512)
#undef LIMN_DECLARE_KERNEL

void FitInverse(InversionCell& cell) {
    constexpr std::array kKernels{sse2::FitInverse, avx2::FitInverse, avx512::FitInverse};
    kKernels[static_cast<size_t>(GetInstructionSet())](cell);
}

void InvertTextureMap(InversionCell const& cell, double const* targetX, double const* targetY,
                      int count, double* x, double* y, Whereabouts* where) {
    constexpr std::array kKernels{sse2::InvertTextureMap, avx2::InvertTextureMap,
                                  avx512::InvertTextureMap};
    kKernels[static_cast<size_t>(GetInstructionSet())](cell, targetX, targetY, count, x, y, where);
}

}  // namespace limn::eval
