// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "eval/cascade/cascade_operator.h"
#include "eval/stencils/table_evaluator.h"

namespace limn::eval {

/// What a cascade applies on a level, as tables of the run's evaluator: interpolation from the
/// coarser level, and Jacobi sweeps. In float, so that rows should be near the origin.
class CascadeTables {
public:
    // Their names among those that an evaluator counts.
    static constexpr char const* kProlongation = "prolongation";
    static constexpr char const* kSweep = "sweep";
    static constexpr char const* kLoad = "load";

    /// \param evaluator  outlives this
    explicit CascadeTables(TableEvaluator& evaluator) : _evaluator(evaluator) {}

    /// \param numCoarse  rows of the coarser level
    void SetLevel(far_ext::CascadeLevel const& level, Index numCoarse);

    CascadeRows<double> Prolong(CascadeRows<double> const& coarse) const;

    void SetOperator(far_ext::CascadeLevel const& level, CascadeOperator<double> const& op);

    /// `count` sweeps on x, towards the solution for x0.
    ///
    /// \param progress  called before each with the share done, if there is one; may throw
    void Sweep(CascadeRows<double> const& x0, CascadeRows<double>& x, int count,
               std::function<void(double)> const& progress) const;

private:
    TableEvaluator& _evaluator;
    std::optional<FixedTable> _prolongation, _sweep, _load;
};

}  // namespace limn::eval
