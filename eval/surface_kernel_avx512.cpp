#define LIMN_KERNEL avx512
#include "eval/surface_kernel.inc"
