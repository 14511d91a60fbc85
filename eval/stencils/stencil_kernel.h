// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "far_ext/stencils/stencil_groups.h"

namespace limn::eval {

/// Values to read, or to write for one weight set: point i has `length` floats at values + i *
/// stride.
struct StencilSource {
    float const* values;
    std::ptrdiff_t stride;
};
struct StencilTarget {
    float* values;
    std::ptrdiff_t stride;
};

/// One evaluation: rows begin..end-1 of a table go to rows begin..end-1 of each target.
struct StencilJob {
    StencilSource source;
    StencilTarget targets[far_ext::kMaxWeightSets];
    int numSets;  ///< how many of the targets, and of the table's weight sets, take part
    int length;
    Index begin, end;
};

/// Rows as Far keeps them, see far_ext::StencilRowsView.
struct StencilRowArrays {
    int const* sizes;
    Index const* offsets;
    Index const* indices;
    float const* weights[far_ext::kMaxWeightSets];
};

/// Single rows of a compiled table, see far_ext::StencilGroups::Run.
struct StencilRunArrays {
    far_ext::StencilGroups::Run const* runs;
    Index const* indices;
    float const* weights;
};

/// Grouped rows as plain pointers, see StencilGroups.
struct StencilGroupArrays {
    far_ext::StencilGroups::Group const* groups;
    far_ext::StencilGroups::Block const* blocks;
    far_ext::StencilGroups::Shape const* shapes;
    int const* runLengths;
    Index const* controls;
    Index const* runStarts;
    float const* weights;
};

/// Rows sorted by size within windows and cut into slices of 16: entry k of slice s lies at
/// (sliceOffsets[s] + k) * 16 + lane.
struct StencilSliceArrays {
    static constexpr int kLanes = 16;
    std::size_t const* sliceOffsets;
    Index const* rows;  ///< per slice and lane: where it goes; -1 where the last slice has no more
    Index const* indices;
    float const* weights[far_ext::kMaxWeightSets];
};

/// Evaluates rows, runs, groups and slices first..last-1. The same bits on every CPU (see
/// eval/kernels/dispatch.h) and whichever ranges the work is cut into. Sums are in this order:
/// grouped rows, column after column; sliced rows, entry after entry; rows and runs, the even
/// entries and the odd ones, then both.
///
/// \pre all indices are valid; no target overlaps the source or another target
struct StencilKernel {
    void (*evaluateRows)(StencilJob const& job, StencilRowArrays const& rows, Index first,
                         Index last);
    void (*evaluateRuns)(StencilJob const& job, StencilRunArrays const& runs, Index first,
                         Index last);
    void (*evaluateGroups)(StencilJob const& job, StencilGroupArrays const& groups, Index first,
                           Index last);
    void (*evaluateSlices)(StencilJob const& job, StencilSliceArrays const& slices, Index first,
                           Index last);

    static StencilKernel const sse2, avx2, avx512;
};

}  // namespace limn::eval
