// SPDX-License-Identifier: Apache-2.0
#define LIMN_KERNEL sse2
#define LIMN_KERNEL_LANES 4
#include "eval/cascade/cascade_kernel.inc"
