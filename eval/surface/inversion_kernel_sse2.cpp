#define LIMN_KERNEL sse2
#include "eval/surface/inversion_kernel.inc"
