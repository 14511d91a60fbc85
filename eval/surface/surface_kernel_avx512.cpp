// SPDX-License-Identifier: Apache-2.0
#define LIMN_KERNEL avx512
#include "eval/surface/surface_kernel.inc"
