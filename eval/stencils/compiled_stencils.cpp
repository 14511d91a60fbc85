// SPDX-License-Identifier: Apache-2.0
#include "eval/stencils/compiled_stencils.h"

#include <algorithm>

#include <fmt/format.h>

#include "eval/kernels/dispatch.h"
#include "eval/parallel/rows.h"
#include "eval/stencils/stencil_kernel.h"
#include "far_ext/error.h"

namespace limn::eval {

namespace {

constexpr Index kRowsPerTask = 8192;  // some tens of microseconds

}  // namespace

CompiledStencils::CompiledStencils(far_ext::StencilGroups groups, Options options)
    : _groups(std::move(groups)) {
    for (auto const& block : _groups.blocks) {
        if (block.numColumns <= far_ext::StencilGroups::kMaxColumns) continue;
        throw Error(
            ErrorCode::BadOption,
            fmt::format("a group of stencils has {} control vertices; at most {} are possible",
                        block.numColumns, far_ext::StencilGroups::kMaxColumns));
    }
    if (options.isSliced) {
        _slices = MakeSlices(_groups);
        _groups.singles = {};
    }
}

CompiledStencils CompiledStencils::Compile(far_ext::StencilRowsView const& rows, Options options) {
    far_ext::Validate(rows);
    return CompiledStencils(far_ext::GroupRows(rows), options);
}

CompiledStencils CompiledStencils::Compile(Far::StencilTableReal<float> const& table,
                                           Options options) {
    return Compile(far_ext::ViewStencils(table), options);
}

CompiledStencils CompiledStencils::Compile(Far::LimitStencilTableReal<float> const& table,
                                           Options options) {
    return Compile(far_ext::ViewLimitStencils(table), options);
}

CompiledStencils::Slices CompiledStencils::MakeSlices(far_ext::StencilGroups const& groups) {
    constexpr Index W = StencilSliceArrays::kLanes;
    constexpr Index kWindow =
        256;  // rows sorted together: far enough for equal sizes, near enough for the cache
    struct Row {
        Index row;
        int size;
        Index firstIndex, firstWeight;
    };
    auto const& singles = groups.singles;
    std::vector<Row> rows;
    for (auto const& run : singles.runs) {
        for (int i = 0; i < run.numRows; ++i) {
            rows.push_back(
                {run.firstRow + i, run.size, run.firstIndex + i * run.size, run.firstWeight});
        }
    }
    Index const numRows = static_cast<Index>(rows.size());
    for (Index begin = 0; begin < numRows; begin += kWindow) {
        std::stable_sort(rows.begin() + begin, rows.begin() + std::min(begin + kWindow, numRows),
                         [](Row const& a, Row const& b) { return a.size > b.size; });
    }
    Slices slices;
    for (Index begin = 0; begin < numRows; begin += W) {
        Index const numLanes = std::min(W, numRows - begin);
        int longest = 0;
        for (Index l = 0; l < numLanes; ++l) longest = std::max(longest, rows[begin + l].size);
        for (int k = 0; k < longest; ++k) {
            for (Index l = 0; l < W; ++l) {
                // Filled up with weight 0 at a point the row uses anyway.
                Row const& row = rows[begin + std::min(l, numLanes - 1)];
                bool const isEntry = l < numLanes && k < row.size;
                slices.indices.push_back(
                    row.size > 0 ? singles.indices[row.firstIndex + std::min(k, row.size - 1)] : 0);
                for (int set = 0; set < groups.numSets; ++set) {
                    Index const weight = row.firstWeight + set * row.size + k;
                    slices.weights[set].push_back(isEntry ? singles.weights[weight] : 0.0f);
                }
            }
        }
        for (Index l = 0; l < W; ++l)
            slices.rows.push_back(l < numLanes ? rows[begin + l].row : -1);
        slices.offsets.push_back(slices.indices.size() / W);
    }
    return slices;
}

std::size_t CompiledStencils::GetMemory() const {
    std::size_t bytes = _groups.GetMemory() + _slices.offsets.size() * sizeof(std::size_t) +
                        (_slices.rows.size() + _slices.indices.size()) * sizeof(Index);
    for (auto const& set : _slices.weights) bytes += set.size() * sizeof(float);
    return bytes;
}

void CompiledStencils::Evaluate(StencilJob const& job) const {
    EvaluateGroups(job);
    EvaluateSingles(job);
    EvaluateSlices(job);
}

void CompiledStencils::EvaluateGroups(StencilJob const& job) const {
    Index const numGroups = static_cast<Index>(_groups.groups.size());
    if (numGroups == 0) return;
    StencilGroupArrays const arrays{_groups.groups.data(),   _groups.blocks.data(),
                                    _groups.shapes.data(),   _groups.runLengths.data(),
                                    _groups.controls.data(), _groups.runStarts.data(),
                                    _groups.weights.data()};
    Index const rowsPerGroup = std::max(1, _groups.numRows / numGroups);
    ForEachBlock(numGroups, std::max(1, kRowsPerTask / rowsPerGroup), [&](Index first, Index last) {
        GetKernel<StencilKernel>().evaluateGroups(job, arrays, first, last);
    });
}

void CompiledStencils::EvaluateSingles(StencilJob const& job) const {
    auto const& singles = _groups.singles;
    Index const numRuns = static_cast<Index>(singles.runs.size());
    if (numRuns == 0) return;
    StencilRunArrays const arrays{singles.runs.data(), singles.indices.data(),
                                  singles.weights.data()};
    Index const rowsPerRun = std::max(1, _groups.numRows / numRuns);
    ForEachBlock(numRuns, std::max(1, kRowsPerTask / rowsPerRun), [&](Index first, Index last) {
        GetKernel<StencilKernel>().evaluateRuns(job, arrays, first, last);
    });
}

void CompiledStencils::EvaluateSlices(StencilJob const& job) const {
    StencilSliceArrays arrays{
        _slices.offsets.data(), _slices.rows.data(), _slices.indices.data(), {}};
    for (int set = 0; set < _groups.numSets; ++set)
        arrays.weights[set] = _slices.weights[set].data();
    ForEachBlock(_slices.GetNum(), kRowsPerTask / StencilSliceArrays::kLanes,
                 [&](Index first, Index last) {
                     GetKernel<StencilKernel>().evaluateSlices(job, arrays, first, last);
                 });
}

}  // namespace limn::eval
