#define LIMN_KERNEL sse2
#include "engine/bake/pixel_kernel.inc"
