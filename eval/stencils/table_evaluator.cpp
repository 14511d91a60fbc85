// SPDX-License-Identifier: Apache-2.0
#include "eval/stencils/table_evaluator.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <utility>

#include "eval/parallel/rows.h"
#include "far_ext/error.h"

namespace limn::eval {

namespace {

constexpr Index kPointsPerBlock = 16384;

far_ext::StencilRows RoundRows(far_ext::SparseRows const& rows, Index numColumns) {
    far_ext::StencilRows rounded(numColumns, 1);
    for (int row = 0; row < rows.GetNumRows(); ++row) {
        for (int k = rows.offsets[row]; k < rows.offsets[row + 1]; ++k) {
            auto const weight = static_cast<float>(rows.weights[k]);
            rounded.AddEntry(rows.indices[k], &weight);
        }
        rounded.EndRow();
    }
    return rounded;
}

/// \return  false where a number is none in float
bool RoundValues(std::span<double const> x, int length, double const* origin,
                 std::vector<float>& rounded) {
    std::atomic<bool> isFinite{true};
    ForEachBlock(static_cast<Index>(x.size()) / length, kPointsPerBlock,
                 [&](Index begin, Index end) {
                     for (size_t i = begin; i < static_cast<size_t>(end); ++i) {
                         for (size_t c = 0; c < static_cast<size_t>(length); ++c) {
                             size_t const k = i * length + c;
                             rounded[k] = static_cast<float>(x[k] - (origin ? origin[c] : 0.0));
                             if (!std::isfinite(rounded[k])) isFinite = false;
                         }
                     }
                 });
    return isFinite;
}

}  // namespace

FixedTable::FixedTable(TableEvaluator& evaluator, size_t use, far_ext::StencilRows rows)
    : _evaluator(&evaluator),
      _use(use),
      _numColumns(rows.GetNumControlVertices()),
      _numSets(rows.GetNumSets()),
      _stencils(evaluator.GetKind(), std::move(rows)) {}

void FixedTable::Apply(std::span<double const> x, int length, std::span<double> y,
                       double const* origin) const {
    auto const size = [&](Index count) { return static_cast<size_t>(count) * length; };
    size_t const numValues = size(GetNumRows()), numResults = numValues * _numSets;
    if (length < 1 || x.size() < size(_numColumns) || y.size() < numResults)
        throw Error(ErrorCode::BadOption, "a table is applied to arrays that are too short for it");
    std::vector<float> source(size(_numColumns)), results(numResults);
    if (!RoundValues(x.first(source.size()), length, origin, source))
        throw Error(ErrorCode::BadMesh, "a value is too large for an evaluator in float");
    Osd::BufferDescriptor const desc(0, length, length);
    SimdEvaluator::Targets targets;
    for (int set = 0; set < _numSets; ++set)
        targets.push_back({results.data() + set * numValues, desc});

    auto const start = std::chrono::steady_clock::now();
    if (GetNumRows() > 0)
        _evaluator->Apply(_evaluator->GetName(_use), _stencils, source.data(), desc, targets);
    _evaluator->Count(
        _use, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    std::copy(results.begin(), results.end(), y.begin());
    if (!origin) return;
    for (size_t k = 0; k < numValues; ++k) y[k] += origin[k % static_cast<size_t>(length)];
}

FixedTable TableEvaluator::Make(std::string const& what, far_ext::StencilRows rows) {
    std::lock_guard const lock(_mutex);
    auto use = std::ranges::find(_uses, what, &TableUse::what);
    if (use == _uses.end()) use = _uses.insert(use, {.what = what});
    use->rows += static_cast<size_t>(rows.GetNumStencils());
    use->entries += rows.GetControlIndices().size();
    return {*this, static_cast<size_t>(use - _uses.begin()), std::move(rows)};
}

FixedTable TableEvaluator::Make(std::string const& what, far_ext::SparseRows const& rows,
                                Index numColumns) {
    return Make(what, RoundRows(rows, numColumns));
}

std::vector<TableUse> TableEvaluator::GetUses() const {
    std::lock_guard const lock(_mutex);
    return _uses;
}

void TableEvaluator::Apply(std::string const& /*what*/, StencilEvaluator const& table,
                           float const* source, Osd::BufferDescriptor const& desc,
                           SimdEvaluator::Targets const& targets) const {
    table.EvalStencils(source, desc, targets, 0, table.GetNumStencils());
}

std::string TableEvaluator::GetName(size_t use) const {
    std::lock_guard const lock(_mutex);
    return _uses[use].what;
}

void TableEvaluator::Count(size_t use, double seconds) {
    std::lock_guard const lock(_mutex);
    ++_uses[use].applications;
    _uses[use].seconds += seconds;
}

std::vector<double> ApplyRows(TableEvaluator* evaluator, std::string const& what,
                              far_ext::SparseRows const& rows, std::vector<double> const& x) {
    if (!evaluator) return rows.Apply(x);
    std::vector<double> y(static_cast<size_t>(rows.GetNumRows()));
    evaluator->Make(what, rows, static_cast<Index>(x.size())).Apply(x, 1, y);
    return y;
}

}  // namespace limn::eval
