// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limn::eval {

/// The instruction sets kernels are compiled for. All give the same bits; wider ones are faster.
enum class InstructionSet { Sse2, Avx2, Avx512 };

/// The one in use: the widest this CPU has, or what LIMN_SIMD (sse2, avx2, avx512) asks for if it
/// has that.
InstructionSet GetInstructionSet();

/// Chooses another one for the whole process. \return false if this CPU lacks it
bool SelectInstructionSet(InstructionSet set);

/// "sse2", "avx2" or "avx512"
char const* GetName(InstructionSet set);

}  // namespace limn::eval
