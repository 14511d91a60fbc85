// SPDX-License-Identifier: Apache-2.0
#include "eval/kernels/dispatch.h"

#include <gtest/gtest.h>

#include "eval/surface/surface_kernel.h"
#include "support/instruction_sets.h"

namespace limn {
namespace {

using eval::InstructionSet;

constexpr InstructionSet kSets[] = {InstructionSet::Sse2, InstructionSet::Avx2,
                                    InstructionSet::Avx512};

/// What the CPU says, for the features that each set's kernels are compiled with.
bool HasCpu(InstructionSet set) {
    switch (set) {
        case InstructionSet::Sse2:
            return __builtin_cpu_supports("sse2");
        case InstructionSet::Avx2:
            return __builtin_cpu_supports("avx2");
        case InstructionSet::Avx512:
            return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                   __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
    }
    return false;
}

TEST(SelectInstructionSet, TakesWhatTheCpuHasAndRefusesTheRest) {
    InstructionSet const first = eval::GetInstructionSet();
    for (InstructionSet set : kSets) {
        InstructionSet const before = eval::GetInstructionSet();
        EXPECT_EQ(eval::SelectInstructionSet(set), HasCpu(set)) << eval::GetName(set);
        EXPECT_EQ(eval::GetInstructionSet(), HasCpu(set) ? set : before) << eval::GetName(set);
    }
    eval::SelectInstructionSet(first);
}

TEST(SelectInstructionSet, RefusesWhatIsNone) {
    InstructionSet const before = eval::GetInstructionSet();
    EXPECT_FALSE(eval::SelectInstructionSet(static_cast<InstructionSet>(3)));
    EXPECT_EQ(eval::GetInstructionSet(), before);
}

TEST(GetKernel, IsTheOneCompiledForTheSetInUse) {
    using Kernel = eval::SurfaceKernel;
    Kernel const* const kernels[] = {&Kernel::sse2, &Kernel::avx2, &Kernel::avx512};
    int numSets = 0;
    test::ForEachInstructionSet([&](InstructionSet set) {
        EXPECT_EQ(&eval::GetKernel<Kernel>(), kernels[static_cast<int>(set)]) << eval::GetName(set);
        ++numSets;
    });
    EXPECT_GE(numSets, 1);  // every x86-64 has SSE2
}

}  // namespace
}  // namespace limn
