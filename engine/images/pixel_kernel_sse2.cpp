// SPDX-License-Identifier: Apache-2.0
#define LIMN_KERNEL sse2
#include "engine/images/pixel_kernel.inc"
