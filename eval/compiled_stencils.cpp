#include "eval/compiled_stencils.h"

#include <algorithm>
#include <numeric>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "eval/stencil_kernel.h"

namespace limn::eval {

namespace {

/// Calls work(first, last) for parts of [0, count), at once where the whole is too small to share.
template <class Work>
void ForParts(Index count, Index grain, Work work) {
    if (count <= grain) {
        if (count > 0) work(Index(0), count);
        return;
    }
    tbb::parallel_for(tbb::blocked_range<Index>(0, count, static_cast<size_t>(grain)),
                      [&](auto const& range) { work(range.begin(), range.end()); });
}

constexpr Index kRowsPerTask = 8192;  // some tens of microseconds

}  // namespace

CompiledStencils::CompiledStencils(far_ext::StencilGroups groups, Options options) : _groups(std::move(groups)) {
    if (options.isForOneColumn) {
        _slices = MakeSlices(_groups);
        _groups.singles = {};
    }
}

CompiledStencils CompiledStencils::Compile(far_ext::StencilRowsView const& rows, Options options) {
    far_ext::Validate(rows);
    return CompiledStencils(far_ext::GroupRows(rows), options);
}

CompiledStencils CompiledStencils::Compile(Far::StencilTable const& table, Options options) {
    return Compile(far_ext::ViewStencils(table), options);
}

CompiledStencils CompiledStencils::Compile(Far::LimitStencilTable const& table, Options options) {
    return Compile(far_ext::ViewLimitStencils(table), options);
}

CompiledStencils::Slices CompiledStencils::MakeSlices(far_ext::StencilGroups const& groups) {
    constexpr Index W = StencilSliceArrays::kLanes;
    constexpr Index kWindow = 256;  // rows sorted together: far enough for equal sizes, near enough for the cache
    auto const& singles = groups.singles;
    auto const sizeOf = [&](Index i) { return singles.offsets[i + 1] - singles.offsets[i]; };
    Index const numRows = singles.GetNumRows();
    std::vector<Index> order(static_cast<size_t>(numRows));
    std::iota(order.begin(), order.end(), 0);
    for (Index begin = 0; begin < numRows; begin += kWindow) {
        std::stable_sort(order.begin() + begin, order.begin() + std::min(begin + kWindow, numRows),
                         [&](Index a, Index b) { return sizeOf(a) > sizeOf(b); });
    }
    Slices slices;
    for (Index begin = 0; begin < numRows; begin += W) {
        Index const numLanes = std::min(W, numRows - begin);
        Index longest = 0;
        for (Index l = 0; l < numLanes; ++l) longest = std::max(longest, sizeOf(order[begin + l]));
        for (Index k = 0; k < longest; ++k) {
            for (Index l = 0; l < W; ++l) {
                // Filled up with weight 0 at a point the row uses anyway.
                Index const row = order[begin + std::min(l, numLanes - 1)], size = sizeOf(row);
                bool const isEntry = l < numLanes && k < size;
                Index const entry = singles.offsets[row] + std::min(k, std::max(size, 1) - 1);
                slices.indices.push_back(size > 0 ? singles.indices[entry] : 0);
                for (int set = 0; set < groups.numSets; ++set) {
                    Index const weight = singles.weightOffsets[row] + set * size + k;
                    slices.weights[set].push_back(isEntry ? singles.weights[weight] : 0.0f);
                }
            }
        }
        for (Index l = 0; l < W; ++l) {
            Index const row = l < numLanes ? order[begin + l] : -1;
            slices.rows.push_back(row < 0 || singles.rows.empty() ? row : singles.rows[row]);
        }
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
    StencilGroupArrays const arrays{_groups.groups.data(),   _groups.blocks.data(),    _groups.shapes.data(),
                                    _groups.runLengths.data(), _groups.controls.data(), _groups.runStarts.data(),
                                    _groups.weights.data()};
    Index const rowsPerGroup = std::max(1, _groups.numRows / numGroups);
    ForParts(numGroups, std::max(1, kRowsPerTask / rowsPerGroup),
             [&](Index first, Index last) { EvaluateStencilGroups(job, arrays, first, last); });
}

void CompiledStencils::EvaluateSingles(StencilJob const& job) const {
    auto const& singles = _groups.singles;
    StencilRowArrays arrays{};
    arrays.offsets = singles.offsets.data();
    arrays.weightOffsets = singles.weightOffsets.data();
    arrays.rows = singles.rows.empty() ? nullptr : singles.rows.data();
    arrays.indices = singles.indices.data();
    arrays.isPacked = true;
    for (int set = 0; set < _groups.numSets; ++set) arrays.weights[set] = singles.weights.data();
    bool const isInOrder = !arrays.rows && singles.GetNumRows() > 0;  // then the table is nothing but these
    Index const begin = isInOrder ? job.begin : 0, end = isInOrder ? job.end : singles.GetNumRows();
    ForParts(end - begin, kRowsPerTask,
             [&](Index first, Index last) { EvaluateStencilRows(job, arrays, begin + first, begin + last); });
}

void CompiledStencils::EvaluateSlices(StencilJob const& job) const {
    StencilSliceArrays arrays{_slices.offsets.data(), _slices.rows.data(), _slices.indices.data(), {}};
    for (int set = 0; set < _groups.numSets; ++set) arrays.weights[set] = _slices.weights[set].data();
    ForParts(_slices.GetNum(), kRowsPerTask / StencilSliceArrays::kLanes,
             [&](Index first, Index last) { EvaluateStencilSlices(job, arrays, first, last); });
}

}  // namespace limn::eval
