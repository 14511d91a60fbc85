#define LIMN_KERNEL avx512
#include "eval/inversion_kernel.inc"
