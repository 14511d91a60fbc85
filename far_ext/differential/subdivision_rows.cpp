// SPDX-License-Identifier: Apache-2.0
#include "far_ext/differential/subdivision_rows.h"

#include <opensubdiv/far/primvarRefiner.h>

#include "far_ext/differential/butterfly.h"

namespace limn::far_ext {

SparseRows BuildSubdivisionRows(Far::TopologyRefiner const& refiner, int level,
                                SubdivisionRule rule) {
    if (rule == SubdivisionRule::Butterfly) return BuildButterfly(refiner, level);
    auto const coarse = WeightRow::Identity(refiner.GetLevel(level - 1).GetNumVertices());
    std::vector<WeightRow> fine(refiner.GetLevel(level).GetNumVertices());
    Far::PrimvarRefinerReal<double>(refiner).Interpolate(level, coarse, fine);
    SparseRows rows;
    for (WeightRow const& row : fine) rows.AddRow(row);
    return rows;
}

}  // namespace limn::far_ext
