// SPDX-License-Identifier: Apache-2.0
#define LIMN_KERNEL avx2
#include "eval/surface/inversion_kernel.inc"
