#define LIMN_KERNEL sse2
#define LIMN_KERNEL_LANES 4
#include "eval/stencil_kernel.inc"
