// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "eval/stencils/simd_evaluator.h"
#include "far_ext/enum_words.h"

namespace limn::eval {

/// What applies a stencil table. All agree within float's rounding; each gives the same bits for
/// any number of threads.
enum class EvaluatorKind {
    Simd,    ///< SimdEvaluator over compiled tables
    OsdCpu,  ///< Osd::CpuEvaluator, the reference, on limn's threads
    OsdOmp   ///< Osd::OmpEvaluator on OpenMP's own threads (OMP_NUM_THREADS); not to be mixed with
             ///< the others in one run: its idle threads keep the cores from them
};

inline constexpr auto kEvaluatorWords =
    MakeEnumWords<EvaluatorKind>("evaluator", {{EvaluatorKind::Simd, "simd"},
                                               {EvaluatorKind::OsdCpu, "osd-cpu"},
                                               {EvaluatorKind::OsdOmp, "osd-omp"}});

constexpr char const* GetName(EvaluatorKind kind) {
    return kEvaluatorWords.GetWord(kind);
}

/// Whether it is there: OsdOmp only where OpenSubdiv was built with OpenMP.
bool IsBuiltIn(EvaluatorKind kind);

/// A stencil table and what applies it, chosen at run time.
class StencilEvaluator {
public:
    /// \throws Error  BadOption: an evaluator that is not built in
    StencilEvaluator(EvaluatorKind kind, far_ext::StencilGroups table);

    /// \throws Error  the same; as far_ext::Validate
    StencilEvaluator(EvaluatorKind kind, far_ext::StencilRows table);

    /// Stencils start..end-1 into rows start..end-1 of each of 1, 3 or 6 targets, in the order of
    /// far_ext::WeightSet; the terms are SimdEvaluator's.
    ///
    /// \throws Error  as SimdEvaluator
    void EvalStencils(float const* source, Osd::BufferDescriptor const& sourceDesc,
                      SimdEvaluator::Targets const& targets, Index start, Index end) const;

    Index GetNumStencils() const {
        return _simd ? _simd->GetNumStencils() : _rows->GetNumStencils();
    }
    EvaluatorKind GetKind() const { return _kind; }

private:
    EvaluatorKind _kind;
    std::optional<CompiledStencils> _simd;      // either this ...
    std::optional<far_ext::StencilRows> _rows;  // ... or this
};

}  // namespace limn::eval
