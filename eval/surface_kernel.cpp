#include "eval/surface_kernel.h"

#include <array>

#include "eval/instruction_set.h"

namespace limn::eval {

#define LIMN_DECLARE_KERNEL(name)                              \
    namespace name {                                           \
    void EvaluateSurface(SurfaceBatch const&, Quantity, bool); \
    void InvertTextureMap(InversionBatch const&, bool);        \
    }
LIMN_DECLARE_KERNEL(sse2)
LIMN_DECLARE_KERNEL(avx2)
LIMN_DECLARE_KERNEL(avx512)
#undef LIMN_DECLARE_KERNEL

void EvaluateSurface(SurfaceBatch const& batch, Quantity quantity, bool isTriangle) {
    constexpr std::array kKernels{sse2::EvaluateSurface, avx2::EvaluateSurface, avx512::EvaluateSurface};
    kKernels[static_cast<size_t>(GetInstructionSet())](batch, quantity, isTriangle);
}

void InvertTextureMap(InversionBatch const& batch, bool isTriangle) {
    constexpr std::array kKernels{sse2::InvertTextureMap, avx2::InvertTextureMap, avx512::InvertTextureMap};
    kKernels[static_cast<size_t>(GetInstructionSet())](batch, isTriangle);
}

}  // namespace limn::eval
