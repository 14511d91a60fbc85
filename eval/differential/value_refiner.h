// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <utility>

#include "eval/differential/subdivide_values.h"
#include "eval/stencils/table_evaluator.h"

namespace limn::eval {

/// Takes values of a uniform refinement from level to level: by kernels in double, or as tables of
/// the run's evaluator, in float; those of the scheme are made once.
class ValueRefiner {
public:
    // Their names among those that an evaluator counts.
    static constexpr char const* kVertexTable = "S0";
    static constexpr char const* kFVarTable = "S0 face-varying";

    /// \param evaluator  null: in double. Both outlive this
    ValueRefiner(Far::TopologyRefiner const& refiner, TableEvaluator* evaluator)
        : _refiner(refiner), _evaluator(evaluator) {}

    Far::TopologyRefiner const& GetRefiner() const { return _refiner; }

    /// Values of level `level` - 1 to those of `level`, N doubles per vertex.
    ///
    /// \throws Error  as SubdivideValues, FixedTable::Apply
    template <size_t N>
    std::vector<double> Refine(int level, std::span<double const> coarse,
                               far_ext::TunedRule const& rule = {}) {
        if (!_evaluator) return SubdivideValues<N>(_refiner, level, rule, coarse);
        return ApplyVertexTable(level, coarse, static_cast<int>(N), rule);
    }

    /// The same of a face-varying channel, N doubles per value.
    template <size_t N>
    std::vector<double> RefineFVar(int level, std::span<double const> coarse, int channel) {
        if (!_evaluator) return RefineValues<N>(_refiner, level, coarse, channel);
        return ApplyFVarTable(level, coarse, static_cast<int>(N), channel);
    }

private:
    using Key = std::pair<int, int>;  // level, face-varying channel or -1

    std::vector<double> ApplyVertexTable(int level, std::span<double const> coarse, int length,
                                         far_ext::TunedRule const& rule);
    std::vector<double> ApplyFVarTable(int level, std::span<double const> coarse, int length,
                                       int channel);

    Far::TopologyRefiner const& _refiner;
    TableEvaluator* _evaluator;
    std::map<Key, FixedTable> _tables;  // of the scheme
};

}  // namespace limn::eval
