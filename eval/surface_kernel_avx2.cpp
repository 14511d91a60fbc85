#define LIMN_KERNEL avx2
#include "eval/surface_kernel.inc"
