// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opensubdiv/osd/bufferDescriptor.h>

#include "eval/stencils/compiled_stencils.h"

namespace limn::eval {

namespace Osd = OpenSubdiv::Osd;

/// Applies stencil tables to primvar data, on all cores and with the widest instructions the CPU
/// has. Stands in for Osd::CpuEvaluator::EvalStencils: the same static overloads, for
/// Far::StencilTable, Far::LimitStencilTable, far_ext::StencilRows and, fastest, CompiledStencils.
///
/// Rows     Stencils start..end-1 go to rows start..end-1 of the destination, whatever the length.
///          (OpenSubdiv's own evaluator writes elsewhere when start > 0.)
/// Data     Any length and stride; descriptors as OpenSubdiv's. Floats between the described ones
///          are left alone. Source values are to be finite: a stencil may multiply a point it does
///          not use by zero. No destination row may overlap the source or another destination;
///          source and destination may share a buffer where their floats are apart.
/// Bits     The same for any number of threads, any sub-range and every x86-64 CPU. A compiled
///          table sums in another order than the table it came from, so the two differ in last
///          bits.
/// Threads  Safe to call from many threads at once; works in the caller's TBB arena.
/// Errors   All overloads: limn::Error with BadOption where a descriptor is inconsistent, lengths
///          differ, a buffer is null, a range leaves the table or the table lacks the derivatives
///          asked for. They return true; an empty table or range is done at once.
/// Usable from C++17.
class SimdEvaluator {
public:
    /// Where the results of one weight set go.
    struct Target {
        float* values;
        Osd::BufferDescriptor desc;
    };

    using Targets = std::vector<Target>;

    /// Values.
    template <class SourceBuffer, class TargetBuffer, class Table>
    static bool EvalStencils(SourceBuffer* source, Osd::BufferDescriptor const& sourceDesc,
                             TargetBuffer* target, Osd::BufferDescriptor const& targetDesc,
                             Table const* table, SimdEvaluator const* instance = nullptr,
                             void* deviceContext = nullptr) {
        (void)instance;
        (void)deviceContext;
        return Apply(Bind(source), sourceDesc, {{Bind(target), targetDesc}}, Require(table));
    }

    static bool EvalStencils(float const* source, Osd::BufferDescriptor const& sourceDesc,
                             float* target, Osd::BufferDescriptor const& targetDesc,
                             int const* sizes, int const* offsets, int const* indices,
                             float const* weights, int start, int end);

    static bool EvalStencils(float const* source, Osd::BufferDescriptor const& sourceDesc,
                             float* target, Osd::BufferDescriptor const& targetDesc,
                             CompiledStencils const& table, int start, int end);

    /// Values and first derivatives.
    template <class SourceBuffer, class TargetBuffer, class Table>
    static bool EvalStencils(SourceBuffer* source, Osd::BufferDescriptor const& sourceDesc,
                             TargetBuffer* target, Osd::BufferDescriptor const& targetDesc,
                             TargetBuffer* du, Osd::BufferDescriptor const& duDesc,
                             TargetBuffer* dv, Osd::BufferDescriptor const& dvDesc,
                             Table const* table, SimdEvaluator const* instance = nullptr,
                             void* deviceContext = nullptr) {
        (void)instance;
        (void)deviceContext;
        return Apply(Bind(source), sourceDesc,
                     {{Bind(target), targetDesc}, {Bind(du), duDesc}, {Bind(dv), dvDesc}},
                     Require(table));
    }

    static bool EvalStencils(float const* source, Osd::BufferDescriptor const& sourceDesc,
                             float* target, Osd::BufferDescriptor const& targetDesc, float* du,
                             Osd::BufferDescriptor const& duDesc, float* dv,
                             Osd::BufferDescriptor const& dvDesc, int const* sizes,
                             int const* offsets, int const* indices, float const* weights,
                             float const* duWeights, float const* dvWeights, int start, int end);

    static bool EvalStencils(float const* source, Osd::BufferDescriptor const& sourceDesc,
                             float* target, Osd::BufferDescriptor const& targetDesc, float* du,
                             Osd::BufferDescriptor const& duDesc, float* dv,
                             Osd::BufferDescriptor const& dvDesc, CompiledStencils const& table,
                             int start, int end);

    /// Values, first and second derivatives.
    template <class SourceBuffer, class TargetBuffer, class Table>
    static bool EvalStencils(SourceBuffer* source, Osd::BufferDescriptor const& sourceDesc,
                             TargetBuffer* target, Osd::BufferDescriptor const& targetDesc,
                             TargetBuffer* du, Osd::BufferDescriptor const& duDesc,
                             TargetBuffer* dv, Osd::BufferDescriptor const& dvDesc,
                             TargetBuffer* duu, Osd::BufferDescriptor const& duuDesc,
                             TargetBuffer* duv, Osd::BufferDescriptor const& duvDesc,
                             TargetBuffer* dvv, Osd::BufferDescriptor const& dvvDesc,
                             Table const* table, SimdEvaluator const* instance = nullptr,
                             void* deviceContext = nullptr) {
        (void)instance;
        (void)deviceContext;
        return Apply(Bind(source), sourceDesc,
                     {{Bind(target), targetDesc},
                      {Bind(du), duDesc},
                      {Bind(dv), dvDesc},
                      {Bind(duu), duuDesc},
                      {Bind(duv), duvDesc},
                      {Bind(dvv), dvvDesc}},
                     Require(table));
    }

    static bool EvalStencils(float const* source, Osd::BufferDescriptor const& sourceDesc,
                             float* target, Osd::BufferDescriptor const& targetDesc, float* du,
                             Osd::BufferDescriptor const& duDesc, float* dv,
                             Osd::BufferDescriptor const& dvDesc, float* duu,
                             Osd::BufferDescriptor const& duuDesc, float* duv,
                             Osd::BufferDescriptor const& duvDesc, float* dvv,
                             Osd::BufferDescriptor const& dvvDesc, int const* sizes,
                             int const* offsets, int const* indices, float const* weights,
                             float const* duWeights, float const* dvWeights,
                             float const* duuWeights, float const* duvWeights,
                             float const* dvvWeights, int start, int end);

    static bool EvalStencils(float const* source, Osd::BufferDescriptor const& sourceDesc,
                             float* target, Osd::BufferDescriptor const& targetDesc, float* du,
                             Osd::BufferDescriptor const& duDesc, float* dv,
                             Osd::BufferDescriptor const& dvDesc, float* duu,
                             Osd::BufferDescriptor const& duuDesc, float* duv,
                             Osd::BufferDescriptor const& duvDesc, float* dvv,
                             Osd::BufferDescriptor const& dvvDesc, CompiledStencils const& table,
                             int start, int end);

    /// What all overloads come down to: 1, 3 or 6 targets, in the order of far_ext::WeightSet.
    static bool Apply(float const* source, Osd::BufferDescriptor const& sourceDesc,
                      Targets const& targets, CompiledStencils const& table, int start, int end);
    static bool Apply(float const* source, Osd::BufferDescriptor const& sourceDesc,
                      Targets const& targets, far_ext::StencilRowsView const& rows, int start,
                      int end);

    /// The checks of all overloads, for a table of numSets weight sets and numRows rows.
    static void Check(float const* source, Osd::BufferDescriptor const& sourceDesc,
                      Targets const& targets, int numSets, int numRows, int start, int end);

private:
    /// \throws Error  BadOption where there is no object
    static void RequireObject(void const* object);

    template <class Table>
    static Table const& Require(Table const* table) {
        RequireObject(table);
        return *table;
    }
    template <class Buffer>
    static auto Bind(Buffer* buffer) {
        RequireObject(buffer);
        return buffer->BindCpuBuffer();
    }

    static bool Apply(float const* source, Osd::BufferDescriptor const& sourceDesc,
                      Targets const& targets, CompiledStencils const& table) {
        return Apply(source, sourceDesc, targets, table, 0, table.GetNumStencils());
    }

    /// Any table with Far's accessors; those of derivatives are only asked for where they are
    /// needed.
    template <class Table>
    static bool Apply(float const* source, Osd::BufferDescriptor const& sourceDesc,
                      Targets const& targets, Table const& table) {
        return Apply(source, sourceDesc, targets, View(table, 0), 0, table.GetNumStencils());
    }

    template <class Table>
    static auto View(Table const& table, int)
        -> decltype((void)table.GetDuuWeights(), far_ext::StencilRowsView()) {
        return far_ext::ViewLimitStencils(table);
    }
    template <class Table>
    static far_ext::StencilRowsView View(Table const& table, long) {
        return far_ext::ViewStencils(table);
    }
};

}  // namespace limn::eval
