// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include "far_ext/rows/sparse_rows.h"

namespace limn::far_ext {

/// Which rules make the points of a level from those before.
enum class SubdivisionRule {
    Scheme,    ///< the refiner's own scheme: OpenSubdiv's Loop or Catmull-Clark
    Butterfly  ///< modified Butterfly on the refiner's Loop topology
};

/// S of one step: vertices of `level` x vertices of `level` - 1. Rows add up to 1.
///
/// \throws Error  as BuildButterfly
SparseRows BuildSubdivisionRows(Far::TopologyRefiner const& refiner, int level,
                                SubdivisionRule rule);

}  // namespace limn::far_ext
