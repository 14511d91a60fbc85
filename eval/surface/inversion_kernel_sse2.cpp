// SPDX-License-Identifier: Apache-2.0
#define LIMN_KERNEL sse2
#include "eval/surface/inversion_kernel.inc"
