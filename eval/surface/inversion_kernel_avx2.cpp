#define LIMN_KERNEL avx2
#include "eval/surface/inversion_kernel.inc"
