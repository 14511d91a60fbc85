// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <variant>

#include "eval/fit/limit_operator.h"
#include "eval/stencils/table_evaluator.h"

namespace limn::eval {

/// The limit matrix A, applied again and again: as limn's operator, in double, or as a table of the
/// run's evaluator, in float.
class LimitApplication {
public:
    /// The name of A's table among those that an evaluator counts.
    static constexpr char const* kTable = "A";

    LimitApplication(LimitOperator A) : _operator(std::move(A)) {}

    /// \param evaluator  null: none. It outlives this
    /// \throws Error     as LimitOperator::Build
    static LimitApplication Build(Far::TopologyRefiner const& refiner,
                                  far_ext::LimitOptions const& options, TableEvaluator* evaluator);

    /// y = A x, of `length` numbers per vertex.
    ///
    /// \throws Error  as FixedTable::Apply
    void Apply(std::span<double const> x, int length, std::span<double> y) const;

private:
    explicit LimitApplication(FixedTable A) : _operator(std::move(A)) {}

    std::variant<LimitOperator, FixedTable> _operator;
};

}  // namespace limn::eval
