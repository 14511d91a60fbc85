#include "eval/surface_kernel.h"

#include <atomic>
#include <cstdlib>
#include <cstring>

namespace limn::eval {

#define LIMN_DECLARE_KERNEL(name)                                       \
    namespace name {                                                    \
    void EvaluateSurface(SurfaceBatch const&, Quantity, bool);          \
    void InvertTextureMap(InversionBatch const&, bool);                 \
    }
LIMN_DECLARE_KERNEL(sse2)
LIMN_DECLARE_KERNEL(avx2)
LIMN_DECLARE_KERNEL(avx512)
#undef LIMN_DECLARE_KERNEL

namespace {

struct Kernel {
    char const* name;
    void (*evaluateSurface)(SurfaceBatch const&, Quantity, bool);
    void (*invertTextureMap)(InversionBatch const&, bool);
};

constexpr Kernel kKernels[] = {{"sse2", sse2::EvaluateSurface, sse2::InvertTextureMap},
                               {"avx2", avx2::EvaluateSurface, avx2::InvertTextureMap},
                               {"avx512", avx512::EvaluateSurface, avx512::InvertTextureMap}};

bool IsSupported(int kernel) {
    __builtin_cpu_init();
    if (kernel == 0) return true;
    if (kernel == 1) return __builtin_cpu_supports("avx2");
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
}

int FindKernel(char const* name) {
    for (int k = 0; k < 3; ++k) {
        if (std::strcmp(kKernels[k].name, name) == 0 && IsSupported(k)) return k;
    }
    return -1;
}

std::atomic<Kernel const*>& Chosen() {
    static std::atomic<Kernel const*> chosen = [] {
        char const* const wish = std::getenv("LIMN_SIMD");
        int kernel = wish ? FindKernel(wish) : -1;
        for (int k = 2; kernel < 0; --k) {
            if (IsSupported(k)) kernel = k;
        }
        return &kKernels[kernel];
    }();
    return chosen;
}

}  // namespace

void EvaluateSurface(SurfaceBatch const& batch, Quantity quantity, bool isTriangle) {
    Chosen().load(std::memory_order_relaxed)->evaluateSurface(batch, quantity, isTriangle);
}

void InvertTextureMap(InversionBatch const& batch, bool isTriangle) {
    Chosen().load(std::memory_order_relaxed)->invertTextureMap(batch, isTriangle);
}

char const* GetSurfaceKernelName() { return Chosen().load()->name; }

bool SelectSurfaceKernel(char const* name) {
    int const kernel = FindKernel(name);
    if (kernel >= 0) Chosen().store(&kKernels[kernel]);
    return kernel >= 0;
}

}  // namespace limn::eval
