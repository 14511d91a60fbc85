#define LIMN_KERNEL avx2
#include "engine/bake/pixel_kernel.inc"
