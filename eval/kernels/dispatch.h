// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "eval/kernels/instruction_set.h"

namespace limn::eval {

// A kernel is plain lane loops in one source, which is compiled once per instruction set; the one
// in use is chosen here, at every call.
//
// Header  x_kernel.h: the types it works on, and
//             struct XKernel {
//                 void (*evaluate)(XJob const& job, Index begin, Index end);
//                 static XKernel const sse2, avx2, avx512;
//             };
// Source  x_kernel.cpp: the functions, in an unnamed namespace, and
//             constinit XKernel const XKernel::LIMN_KERNEL = {Evaluate};
//         LIMN_KERNEL is sse2, avx2 or avx512, LIMN_KERNEL_LANES the floats of its registers. It
//         is a line of KERNELS in its floor's CMakeLists.txt.
// Caller  GetKernel<XKernel>().evaluate(job, begin, end);
// Bits    The same at every width, [Limit 11]: no contraction, no library calls, sums in a fixed
//         order, choices as plain ternaries.
// Linker  Of equal inline functions a linker keeps one, wherever it was compiled: one from an
//         avx512 object could end up in the code that other CPUs run. So a kernel's object defines
//         its table and nothing else that is seen outside: it uses no inline function and no
//         template of a header, those of the standard library included (tests look at the objects).

/// The kernel's functions as compiled for the instruction set in use.
template <class Kernel>
Kernel const& GetKernel() {
    constexpr Kernel const* kKernels[] = {&Kernel::sse2, &Kernel::avx2, &Kernel::avx512};
    return *kKernels[static_cast<std::size_t>(GetInstructionSet())];
}

}  // namespace limn::eval
