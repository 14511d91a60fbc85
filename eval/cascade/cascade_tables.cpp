// SPDX-License-Identifier: Apache-2.0
#include "eval/cascade/cascade_tables.h"

#include <span>

#include "eval/cascade/sweep_matrices.h"

namespace limn::eval {

namespace {

/// Four numbers per row, as they lie in memory.
constexpr int kRowLength = 4;

CascadeRows<double> ApplyTo(FixedTable const& table, CascadeRows<double> const& x) {
    CascadeRows<double> y(static_cast<size_t>(table.GetNumRows()));
    if (y.empty()) return y;
    table.Apply({x.data()->data(), kRowLength * x.size()}, kRowLength,
                {y.data()->data(), kRowLength * y.size()});
    return y;
}

}  // namespace

void CascadeTables::SetLevel(far_ext::CascadeLevel const& level, Index numCoarse) {
    far_ext::SparseRows means;
    means.offsets = level.parentOffsets;
    means.indices.assign(level.parents.begin(), level.parents.end());
    for (Index row = 0; row < level.GetNumRows(); ++row) {
        int const count = level.parentOffsets[row + 1] - level.parentOffsets[row];
        means.weights.insert(means.weights.end(), static_cast<size_t>(count), 1.0 / count);
    }
    _prolongation = _evaluator.Make(kProlongation, means, numCoarse);
}

CascadeRows<double> CascadeTables::Prolong(CascadeRows<double> const& coarse) const {
    return ApplyTo(*_prolongation, coarse);
}

void CascadeTables::SetOperator(far_ext::CascadeLevel const& level,
                                CascadeOperator<double> const& op) {
    auto const matrices = MakeSweepMatrices(level, op);
    _sweep = _evaluator.Make(kSweep, matrices.sweep, level.GetNumRows());
    _load = _evaluator.Make(kLoad, matrices.load, level.GetNumRows());
}

void CascadeTables::Sweep(CascadeRows<double> const& x0, CascadeRows<double>& x, int count,
                          std::function<void(double)> const& progress) const {
    CascadeRows<double> const load = ApplyTo(*_load, x0);
    for (int done = 0; done < count; ++done) {
        if (progress) progress(static_cast<double>(done) / count);
        x = ApplyTo(*_sweep, x);
        for (size_t row = 0; row < x.size(); ++row) x[row] += load[row];
    }
}

}  // namespace limn::eval
