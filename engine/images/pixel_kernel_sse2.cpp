#define LIMN_KERNEL sse2
#include "engine/images/pixel_kernel.inc"
