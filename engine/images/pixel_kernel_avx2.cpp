#define LIMN_KERNEL avx2
#include "engine/images/pixel_kernel.inc"
