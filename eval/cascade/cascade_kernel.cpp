// SPDX-License-Identifier: Apache-2.0
#include "eval/cascade/cascade_kernel.h"

#include <array>
#include <cstddef>

#include "eval/kernels/instruction_set.h"
#include "far_ext/cascade/cascade_level.h"

namespace limn::eval {

#define LIMN_DECLARE_KERNEL(name)                                                         \
    namespace name {                                                                      \
    CascadeShapes<float> BuildCascadeRows(CascadeBuildJob<float> const&, Index, Index);   \
    CascadeShapes<double> BuildCascadeRows(CascadeBuildJob<double> const&, Index, Index); \
    void SweepCascadeRows(CascadeSweepJob<float> const&, Index, Index);                   \
    void SweepCascadeRows(CascadeSweepJob<double> const&, Index, Index);                  \
    }
LIMN_DECLARE_KERNEL(sse2)
LIMN_DECLARE_KERNEL(avx2)
LIMN_DECLARE_KERNEL(avx512)
#undef LIMN_DECLARE_KERNEL

namespace {

template <class Scalar>
CascadeShapes<Scalar> Build(CascadeBuildJob<Scalar> const& job, Index begin, Index end) {
    using Kernel = CascadeShapes<Scalar> (*)(CascadeBuildJob<Scalar> const&, Index, Index);
    constexpr std::array<Kernel, 3> kKernels{sse2::BuildCascadeRows, avx2::BuildCascadeRows,
                                             avx512::BuildCascadeRows};
    return kKernels[static_cast<size_t>(GetInstructionSet())](job, begin, end);
}

template <class Scalar>
void Sweep(CascadeSweepJob<Scalar> const& job, Index begin, Index end) {
    using Kernel = void (*)(CascadeSweepJob<Scalar> const&, Index, Index);
    constexpr std::array<Kernel, 3> kKernels{sse2::SweepCascadeRows, avx2::SweepCascadeRows,
                                             avx512::SweepCascadeRows};
    kKernels[static_cast<size_t>(GetInstructionSet())](job, begin, end);
}

}  // namespace

CascadeRings GetRings(far_ext::CascadeLevel const& level) {
    return {level.offsets.data(), level.neighbours.data(), level.faceSize, level.numClosed,
            level.numSurface};
}

CascadeShapes<float> BuildCascadeRows(CascadeBuildJob<float> const& job, Index begin, Index end) {
    return Build(job, begin, end);
}
CascadeShapes<double> BuildCascadeRows(CascadeBuildJob<double> const& job, Index begin, Index end) {
    return Build(job, begin, end);
}
void SweepCascadeRows(CascadeSweepJob<float> const& job, Index begin, Index end) {
    Sweep(job, begin, end);
}
void SweepCascadeRows(CascadeSweepJob<double> const& job, Index begin, Index end) {
    Sweep(job, begin, end);
}

}  // namespace limn::eval
