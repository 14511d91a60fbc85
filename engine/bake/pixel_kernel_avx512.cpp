#define LIMN_KERNEL avx512
#include "engine/bake/pixel_kernel.inc"
