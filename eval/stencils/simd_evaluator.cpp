// SPDX-License-Identifier: Apache-2.0
#include "eval/stencils/simd_evaluator.h"

#include <fmt/format.h>

#include "eval/kernels/dispatch.h"
#include "eval/parallel/rows.h"
#include "eval/stencils/stencil_kernel.h"
#include "far_ext/error.h"

namespace limn::eval {

using Osd::BufferDescriptor;

namespace {

[[noreturn]] void Refuse(std::string const& message) {
    throw Error(ErrorCode::BadOption, message);
}

StencilJob MakeJob(float const* source, BufferDescriptor const& sourceDesc,
                   SimdEvaluator::Targets const& targets, int start, int end) {
    StencilJob job{
        {source + sourceDesc.offset, sourceDesc.stride}, {}, 0, sourceDesc.length, start, end};
    for (auto const& target : targets) {
        job.targets[job.numSets++] = {target.values + target.desc.offset, target.desc.stride};
    }
    return job;
}

/// Far's arrays as a view; how many rows there are is the caller's word.
far_ext::StencilRowsView MakeView(int const* sizes, int const* offsets, int const* indices,
                                  std::initializer_list<float const*> weights, int end) {
    far_ext::StencilRowsView view{sizes, offsets, indices, {}, 0, end, 0};
    for (float const* set : weights) view.weights[view.numSets++] = set;
    return view;
}

}  // namespace

void SimdEvaluator::RequireObject(void const* object) {
    if (!object) Refuse("a stencil evaluation lacks a buffer or a table: a null pointer");
}

void SimdEvaluator::Check(float const* source, BufferDescriptor const& sourceDesc,
                          Targets const& targets, int numSets, int numRows, int start, int end) {
    auto const check = [&](char const* what, void const* values, BufferDescriptor const& desc) {
        if (!values) Refuse(fmt::format("the {} of a stencil evaluation is a null pointer", what));
        if (!desc.IsValid() || desc.offset < 0) {
            Refuse(
                fmt::format("the {} of a stencil evaluation has length {}, stride {} and offset "
                            "{}; a length is at "
                            "least 1, an offset not negative, and a stride holds both",
                            what, desc.length, desc.stride, desc.offset));
        }
        if (desc.length != sourceDesc.length) {
            Refuse(fmt::format("the {} of a stencil evaluation has length {}, its source {}", what,
                               desc.length, sourceDesc.length));
        }
    };
    check("source", source, sourceDesc);
    for (auto const& target : targets) check("destination", target.values, target.desc);
    if (targets.size() != 1 && targets.size() != 3 && targets.size() != far_ext::kMaxWeightSets) {
        Refuse(
            fmt::format("a stencil evaluation has 1, 3 or 6 destinations, not {}", targets.size()));
    }
    if (targets.size() > static_cast<size_t>(numSets)) {
        Refuse(fmt::format(
            "a stencil evaluation asks for {} results (values, then derivatives); its table has {}",
            targets.size(), numSets));
    }
    if (start < 0 || end > numRows) {
        Refuse(fmt::format("a stencil evaluation covers stencils {} to {}; there are 0 to {}",
                           start, end - 1, numRows - 1));
    }
}

bool SimdEvaluator::Apply(float const* source, BufferDescriptor const& sourceDesc,
                          Targets const& targets, CompiledStencils const& table, int start,
                          int end) {
    if (end <= start) return true;
    Check(source, sourceDesc, targets, table.GetNumSets(), table.GetNumStencils(), start, end);
    table.Evaluate(MakeJob(source, sourceDesc, targets, start, end));
    return true;
}

bool SimdEvaluator::Apply(float const* source, BufferDescriptor const& sourceDesc,
                          Targets const& targets, far_ext::StencilRowsView const& rows, int start,
                          int end) {
    if (end <= start) return true;
    Check(source, sourceDesc, targets, rows.numSets, rows.numRows, start, end);
    if (!rows.sizes || !rows.offsets || !rows.indices)
        Refuse("a stencil table lacks sizes, offsets or indices");
    StencilRowArrays arrays{rows.sizes, rows.offsets, rows.indices, {}};
    for (size_t set = 0; set < targets.size(); ++set) {
        arrays.weights[set] = rows.weights[set];
        if (!arrays.weights[set]) Refuse("a stencil table lacks weights");
    }
    StencilJob const job = MakeJob(source, sourceDesc, targets, start, end);
    constexpr Index kRowsPerTask = 4096;
    ForEachBlock(end - start, kRowsPerTask, [&](Index first, Index last) {
        GetKernel<StencilKernel>().evaluateRows(job, arrays, start + first, start + last);
    });
    return true;
}

bool SimdEvaluator::EvalStencils(float const* source, BufferDescriptor const& sourceDesc,
                                 float* target, BufferDescriptor const& targetDesc,
                                 int const* sizes, int const* offsets, int const* indices,
                                 float const* weights, int start, int end) {
    return Apply(source, sourceDesc, {{target, targetDesc}},
                 MakeView(sizes, offsets, indices, {weights}, end), start, end);
}

bool SimdEvaluator::EvalStencils(float const* source, BufferDescriptor const& sourceDesc,
                                 float* target, BufferDescriptor const& targetDesc,
                                 CompiledStencils const& table, int start, int end) {
    return Apply(source, sourceDesc, {{target, targetDesc}}, table, start, end);
}

bool SimdEvaluator::EvalStencils(float const* source, BufferDescriptor const& sourceDesc,
                                 float* target, BufferDescriptor const& targetDesc, float* du,
                                 BufferDescriptor const& duDesc, float* dv,
                                 BufferDescriptor const& dvDesc, int const* sizes,
                                 int const* offsets, int const* indices, float const* weights,
                                 float const* duWeights, float const* dvWeights, int start,
                                 int end) {
    return Apply(source, sourceDesc, {{target, targetDesc}, {du, duDesc}, {dv, dvDesc}},
                 MakeView(sizes, offsets, indices, {weights, duWeights, dvWeights}, end), start,
                 end);
}

bool SimdEvaluator::EvalStencils(float const* source, BufferDescriptor const& sourceDesc,
                                 float* target, BufferDescriptor const& targetDesc, float* du,
                                 BufferDescriptor const& duDesc, float* dv,
                                 BufferDescriptor const& dvDesc, CompiledStencils const& table,
                                 int start, int end) {
    return Apply(source, sourceDesc, {{target, targetDesc}, {du, duDesc}, {dv, dvDesc}}, table,
                 start, end);
}

bool SimdEvaluator::EvalStencils(
    float const* source, BufferDescriptor const& sourceDesc, float* target,
    BufferDescriptor const& targetDesc, float* du, BufferDescriptor const& duDesc, float* dv,
    BufferDescriptor const& dvDesc, float* duu, BufferDescriptor const& duuDesc, float* duv,
    BufferDescriptor const& duvDesc, float* dvv, BufferDescriptor const& dvvDesc, int const* sizes,
    int const* offsets, int const* indices, float const* weights, float const* duWeights,
    float const* dvWeights, float const* duuWeights, float const* duvWeights,
    float const* dvvWeights, int start, int end) {
    return Apply(source, sourceDesc,
                 {{target, targetDesc},
                  {du, duDesc},
                  {dv, dvDesc},
                  {duu, duuDesc},
                  {duv, duvDesc},
                  {dvv, dvvDesc}},
                 MakeView(sizes, offsets, indices,
                          {weights, duWeights, dvWeights, duuWeights, duvWeights, dvvWeights}, end),
                 start, end);
}

bool SimdEvaluator::EvalStencils(float const* source, BufferDescriptor const& sourceDesc,
                                 float* target, BufferDescriptor const& targetDesc, float* du,
                                 BufferDescriptor const& duDesc, float* dv,
                                 BufferDescriptor const& dvDesc, float* duu,
                                 BufferDescriptor const& duuDesc, float* duv,
                                 BufferDescriptor const& duvDesc, float* dvv,
                                 BufferDescriptor const& dvvDesc, CompiledStencils const& table,
                                 int start, int end) {
    return Apply(source, sourceDesc,
                 {{target, targetDesc},
                  {du, duDesc},
                  {dv, dvDesc},
                  {duu, duuDesc},
                  {duv, duvDesc},
                  {dvv, dvvDesc}},
                 table, start, end);
}

}  // namespace limn::eval
