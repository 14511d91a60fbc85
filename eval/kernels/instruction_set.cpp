// SPDX-License-Identifier: Apache-2.0
#include "eval/kernels/instruction_set.h"

#include <atomic>
#include <cstdlib>
#include <cstring>

namespace limn::eval {

namespace {

constexpr InstructionSet kWidestFirst[] = {InstructionSet::Avx512, InstructionSet::Avx2,
                                           InstructionSet::Sse2};

bool IsSupported(InstructionSet set) {
    __builtin_cpu_init();
    switch (set) {
        case InstructionSet::Avx512:
            return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                   __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
        case InstructionSet::Avx2:
            return __builtin_cpu_supports("avx2");
        case InstructionSet::Sse2:
            return true;
    }
    return false;
}

InstructionSet ChooseInstructionSet() {
    char const* const wish = std::getenv("LIMN_SIMD");
    for (InstructionSet set : kWidestFirst) {
        if (wish && IsSupported(set) && std::strcmp(wish, GetName(set)) == 0) return set;
    }
    for (InstructionSet set : kWidestFirst) {
        if (IsSupported(set)) return set;
    }
    return InstructionSet::Sse2;
}

std::atomic<InstructionSet>& Chosen() {
    static std::atomic<InstructionSet> chosen = ChooseInstructionSet();
    return chosen;
}

}  // namespace

InstructionSet GetInstructionSet() {
    return Chosen().load(std::memory_order_relaxed);
}

bool SelectInstructionSet(InstructionSet set) {
    if (!IsSupported(set)) return false;
    Chosen() = set;
    return true;
}

char const* GetName(InstructionSet set) {
    constexpr char const* kNames[] = {"sse2", "avx2", "avx512"};
    return kNames[static_cast<int>(set)];
}

}  // namespace limn::eval
