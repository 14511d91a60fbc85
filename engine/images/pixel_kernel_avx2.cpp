// SPDX-License-Identifier: Apache-2.0
#define LIMN_KERNEL avx2
#include "engine/images/pixel_kernel.inc"
