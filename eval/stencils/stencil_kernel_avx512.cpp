// SPDX-License-Identifier: Apache-2.0
#define LIMN_KERNEL avx512
#define LIMN_KERNEL_LANES 16
#include "eval/stencils/stencil_kernel.inc"
