#define LIMN_KERNEL sse2
#include "eval/surface_kernel.inc"
