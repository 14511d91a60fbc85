#define LIMN_KERNEL avx2
#include "eval/inversion_kernel.inc"
