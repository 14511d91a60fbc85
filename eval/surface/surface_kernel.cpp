// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/surface_kernel.h"

#include <array>

#include "eval/kernels/instruction_set.h"

namespace limn::eval {

#define LIMN_DECLARE_KERNEL(name)                                              \
    namespace name {                                                           \
    void EvaluateSurfaceInFloat(SurfaceBatch<float> const&, Quantity, bool);   \
    void EvaluateSurfaceInDouble(SurfaceBatch<double> const&, Quantity, bool); \
    }
LIMN_DECLARE_KERNEL(sse2)
LIMN_DECLARE_KERNEL(avx2)
LIMN_DECLARE_KERNEL(avx512)
#undef LIMN_DECLARE_KERNEL

void EvaluateSurface(SurfaceBatch<float> const& batch, Quantity quantity, bool isTriangle) {
    constexpr std::array kKernels{sse2::EvaluateSurfaceInFloat, avx2::EvaluateSurfaceInFloat,
                                  avx512::EvaluateSurfaceInFloat};
    kKernels[static_cast<size_t>(GetInstructionSet())](batch, quantity, isTriangle);
}

void EvaluateSurface(SurfaceBatch<double> const& batch, Quantity quantity, bool isTriangle) {
    constexpr std::array kKernels{sse2::EvaluateSurfaceInDouble, avx2::EvaluateSurfaceInDouble,
                                  avx512::EvaluateSurfaceInDouble};
    kKernels[static_cast<size_t>(GetInstructionSet())](batch, quantity, isTriangle);
}

}  // namespace limn::eval
