// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include "far_ext/rows/sparse_rows.h"

namespace limn::far_ext {

/// The interpolating rule that a step of Loop's or Catmull-Clark's holds: vertices stay, and a new
/// point is moved back by the mean of what the step would have moved the vertices at its edge's
/// ends, or its face's corners, by.
///
/// Shape     that of `approximating`
/// Weights   add up to 1 in each row. Regular Loop edges, times 32: 17 on the ends, 2 on both
///           opposite, -1 on the six other neighbours of the ends. Boundaries, creases and corners
///           are whatever they are in `approximating`; (-1, 9, 9, -1)/16 on smooth curves.
/// \param refiner        by Loop's or Catmull-Clark's scheme, refined uniformly to `level` at least
/// \param approximating  the scheme's own step to `level`: BuildSubdivisionRows
/// Source    [Differential 2]; the principle is [Zhu11]'s reference [36]
SparseRows DeduceInterpolatingRows(Far::TopologyRefiner const& refiner, int level,
                                   SparseRows const& approximating);

}  // namespace limn::far_ext
