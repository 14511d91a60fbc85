// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/value_refiner.h"

namespace limn::eval {

namespace {

/// Rows add up to 1: relative to any of the values, floats keep the digits of a far mesh.
std::vector<double> ApplyNearFirst(FixedTable const& table, std::span<double const> coarse,
                                   int length) {
    std::vector<double> fine(static_cast<size_t>(table.GetNumRows()) * length);
    table.Apply(coarse, length, fine, coarse.data());
    return fine;
}

}  // namespace

std::vector<double> ValueRefiner::ApplyVertexTable(int level, std::span<double const> coarse,
                                                   int length, far_ext::TunedRule const& rule) {
    auto const make = [&] {
        return _evaluator->Make(kVertexTable, far_ext::BuildSubdivisionRows(_refiner, level, rule),
                                _refiner.GetLevel(level - 1).GetNumVertices());
    };
    if (rule.IsInterpolating()) return ApplyNearFirst(make(), coarse, length);
    Key const key{level, -1};
    auto found = _tables.find(key);
    if (found == _tables.end()) found = _tables.emplace(key, make()).first;
    return ApplyNearFirst(found->second, coarse, length);
}

std::vector<double> ValueRefiner::ApplyFVarTable(int level, std::span<double const> coarse,
                                                 int length, int channel) {
    Key const key{level, channel};
    auto found = _tables.find(key);
    if (found == _tables.end()) {
        auto const rows = far_ext::BuildFVarSubdivisionRows(_refiner, level, channel);
        Index const numColumns = _refiner.GetLevel(level - 1).GetNumFVarValues(channel);
        found = _tables.emplace(key, _evaluator->Make(kFVarTable, rows, numColumns)).first;
    }
    return ApplyNearFirst(found->second, coarse, length);
}

}  // namespace limn::eval
