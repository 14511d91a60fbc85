// SPDX-License-Identifier: Apache-2.0
#include "eval/stencils/stencil_kernel.h"

#include <array>

#include "eval/kernels/instruction_set.h"

namespace limn::eval {

#define LIMN_DECLARE_KERNEL(name)                                                           \
    namespace name {                                                                        \
    void EvaluateStencilRows(StencilJob const&, StencilRowArrays const&, Index, Index);     \
    void EvaluateStencilRuns(StencilJob const&, StencilRunArrays const&, Index, Index);     \
    void EvaluateStencilGroups(StencilJob const&, StencilGroupArrays const&, Index, Index); \
    void EvaluateStencilSlices(StencilJob const&, StencilSliceArrays const&, Index, Index); \
    }
LIMN_DECLARE_KERNEL(sse2)
LIMN_DECLARE_KERNEL(avx2)
LIMN_DECLARE_KERNEL(avx512)
#undef LIMN_DECLARE_KERNEL

void EvaluateStencilRows(StencilJob const& job, StencilRowArrays const& rows, Index first,
                         Index last) {
    constexpr std::array kKernels{sse2::EvaluateStencilRows, avx2::EvaluateStencilRows,
                                  avx512::EvaluateStencilRows};
    kKernels[static_cast<size_t>(GetInstructionSet())](job, rows, first, last);
}

void EvaluateStencilRuns(StencilJob const& job, StencilRunArrays const& runs, Index first,
                         Index last) {
    constexpr std::array kKernels{sse2::EvaluateStencilRuns, avx2::EvaluateStencilRuns,
                                  avx512::EvaluateStencilRuns};
    kKernels[static_cast<size_t>(GetInstructionSet())](job, runs, first, last);
}

void EvaluateStencilGroups(StencilJob const& job, StencilGroupArrays const& groups, Index first,
                           Index last) {
    constexpr std::array kKernels{sse2::EvaluateStencilGroups, avx2::EvaluateStencilGroups,
                                  avx512::EvaluateStencilGroups};
    kKernels[static_cast<size_t>(GetInstructionSet())](job, groups, first, last);
}

void EvaluateStencilSlices(StencilJob const& job, StencilSliceArrays const& slices, Index first,
                           Index last) {
    constexpr std::array kKernels{sse2::EvaluateStencilSlices, avx2::EvaluateStencilSlices,
                                  avx512::EvaluateStencilSlices};
    kKernels[static_cast<size_t>(GetInstructionSet())](job, slices, first, last);
}

}  // namespace limn::eval
