// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "eval/kernels/instruction_set.h"

namespace limn::test {

/// Calls act(set) for each instruction set that this CPU has, the narrowest first, while that one
/// is in use; then the one that was in use before is again.
template <class Act>
void ForEachInstructionSet(Act act) {
    using eval::InstructionSet;
    InstructionSet const before = eval::GetInstructionSet();
    for (auto set : {InstructionSet::Sse2, InstructionSet::Avx2, InstructionSet::Avx512}) {
        if (eval::SelectInstructionSet(set)) act(set);
    }
    eval::SelectInstructionSet(before);
}

}  // namespace limn::test
