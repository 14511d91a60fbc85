// SPDX-License-Identifier: Apache-2.0
#define LIMN_KERNEL avx2
#define LIMN_KERNEL_LANES 8
#include "eval/stencils/stencil_kernel.inc"
