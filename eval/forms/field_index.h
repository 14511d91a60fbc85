// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/types.h"

namespace limn::eval {

/// Where a 1-form's field vanishes or turns, read off the signs of its values: at a vertex 1 - c/2
/// for c changes of sign among the spokes (1: source or sink, -1: saddle), at a face 1 - c/2 for c
/// changes among its sides (1: vortex). On a boundary vertex the fan is open and the index (1 -
/// c)/2: 0 where the field passes through or along.
struct FieldSingularity {
    bool isFace;
    Index element;  ///< vertex or face
    double index;
};

struct FieldIndices {
    std::vector<FieldSingularity>
        singularities;  ///< all with an index other than 0; vertices first, in order
    double sum = 0.0;   ///< the Euler characteristic, by the theorem of Poincare and Hopf
};

/// \param form  per edge; 0 counts as positive, on boundary edges as their face runs, so that every
///              edge has a direction and a field straight across a boundary is not singular there
/// Source  [Gortler06]; [Forms 10]
FieldIndices FindFieldIndices(Far::TopologyLevel const& level, std::span<double const> form);

}  // namespace limn::eval
