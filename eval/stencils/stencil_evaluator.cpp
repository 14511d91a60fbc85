// SPDX-License-Identifier: Apache-2.0
#include "eval/stencils/stencil_evaluator.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <opensubdiv/osd/cpuEvaluator.h>

#include "eval/parallel/rows.h"
#include "far_ext/error.h"

#if __has_include(<opensubdiv/osd/ompEvaluator.h>)  // not installed by a build without OpenMP
#include <opensubdiv/osd/ompEvaluator.h>
#define LIMN_HAS_OMP_EVALUATOR true
#else
#define LIMN_HAS_OMP_EVALUATOR false
#endif

namespace limn::eval {

using Osd::BufferDescriptor;
using Targets = SimdEvaluator::Targets;

namespace {

/// Rows first..last-1 through one of OpenSubdiv's evaluators. Its own ranges are not to be trusted
/// (see SimdEvaluator), so the table's pointers and the targets' are moved, and it starts at 0.
template <class Evaluator>
void EvaluateRange(float const* source, BufferDescriptor const& sourceDesc, Targets const& targets,
                   far_ext::StencilRowsView const& rows, Index first, Index last) {
    Index const begin = rows.offsets[first];
    int const* const sizes = rows.sizes + first;
    Index const* const offsets = rows.offsets + first;
    Index const* const indices = rows.indices + begin;
    auto const weights = [&](size_t set) { return rows.weights[set] + begin; };
    auto const target = [&](size_t set) {
        return targets[set].values + static_cast<std::ptrdiff_t>(first) * targets[set].desc.stride;
    };
    auto const desc = [&](size_t set) -> BufferDescriptor const& { return targets[set].desc; };
    Index const count = last - first;
    switch (targets.size()) {
        case 1:
            Evaluator::EvalStencils(source, sourceDesc, target(0), desc(0), sizes, offsets, indices,
                                    weights(0), 0, count);
            break;
        case 3:
            Evaluator::EvalStencils(source, sourceDesc, target(0), desc(0), target(1), desc(1),
                                    target(2), desc(2), sizes, offsets, indices, weights(0),
                                    weights(1), weights(2), 0, count);
            break;
        default:
            Evaluator::EvalStencils(
                source, sourceDesc, target(0), desc(0), target(1), desc(1), target(2), desc(2),
                target(3), desc(3), target(4), desc(4), target(5), desc(5), sizes, offsets, indices,
                weights(0), weights(1), weights(2), weights(3), weights(4), weights(5), 0, count);
    }
}

#if LIMN_HAS_OMP_EVALUATOR
using OmpEvaluator = Osd::OmpEvaluator;
#else
using OmpEvaluator = Osd::CpuEvaluator;  // which nobody comes to
#endif

void RequireBuiltIn(EvaluatorKind kind) {
    if (IsBuiltIn(kind)) return;
    throw Error(ErrorCode::BadOption, std::string("evaluator ") + GetName(kind) +
                                          ": this OpenSubdiv was built without OpenMP");
}

}  // namespace

bool IsBuiltIn(EvaluatorKind kind) {
    return kind != EvaluatorKind::OsdOmp || LIMN_HAS_OMP_EVALUATOR;
}

StencilEvaluator::StencilEvaluator(EvaluatorKind kind, far_ext::StencilGroups table) : _kind(kind) {
    RequireBuiltIn(kind);
    if (kind == EvaluatorKind::Simd)
        _simd.emplace(std::move(table));
    else
        _rows.emplace(table.Expand());
}

StencilEvaluator::StencilEvaluator(EvaluatorKind kind, far_ext::StencilRows table) : _kind(kind) {
    RequireBuiltIn(kind);
    far_ext::Validate(table.GetView());
    if (kind == EvaluatorKind::Simd)
        _simd.emplace(far_ext::GroupRows(table.GetView()));
    else
        _rows.emplace(std::move(table));
}

void StencilEvaluator::EvalStencils(float const* source, BufferDescriptor const& sourceDesc,
                                    Targets const& targets, Index start, Index end) const {
    if (end <= start) return;
    if (_simd) {
        SimdEvaluator::Apply(source, sourceDesc, targets, *_simd, start, end);
        return;
    }
    far_ext::StencilRowsView const rows = _rows->GetView();
    SimdEvaluator::Check(source, sourceDesc, targets, rows.numSets, rows.numRows, start, end);
    if (_kind == EvaluatorKind::OsdOmp) {
        EvaluateRange<OmpEvaluator>(source, sourceDesc, targets, rows, start, end);
        return;
    }
    constexpr Index kRowsPerTask = 4096;
    ForEachBlock(end - start, kRowsPerTask, [&](Index first, Index last) {
        EvaluateRange<Osd::CpuEvaluator>(source, sourceDesc, targets, rows, start + first,
                                         start + last);
    });
}

}  // namespace limn::eval
