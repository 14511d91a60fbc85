#define LIMN_KERNEL sse2
#include "eval/inversion_kernel.inc"
