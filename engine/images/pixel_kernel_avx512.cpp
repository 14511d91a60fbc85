#define LIMN_KERNEL avx512
#include "engine/images/pixel_kernel.inc"
