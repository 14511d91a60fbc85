// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "eval/differential/refine_values.h"
#include "far_ext/differential/subdivision_rows.h"

namespace limn::eval {

/// Values of level `level` - 1 to those of `level` by a rule, N doubles per vertex.
template <size_t N>
std::vector<double> SubdivideValues(Far::TopologyRefiner const& refiner, int level,
                                    far_ext::TunedRule const& rule,
                                    std::span<double const> coarse) {
    if (!rule.IsInterpolating()) return RefineValues<N>(refiner, level, coarse);
    far_ext::SparseRows const rows = far_ext::BuildSubdivisionRows(refiner, level, rule);
    std::vector<double> fine(rows.GetNumRows() * N);
    rows.Apply(coarse.data(), fine.data(), static_cast<int>(N));
    return fine;
}

}  // namespace limn::eval
