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

/// Signs     0 counts as positive. Two kinds of edges do not go by their sign, for what flows along
///           them is rounding or next to it: those of a boundary that the field crosses at a right
///           angle run as their face, so that it is not singular there; and where the field turns
///           round a vertex, the vertex' edges leave it, so that it is the middle of one vortex and
///           not a saddle among several.
/// \param form  per edge
/// Source  [Gortler06]; [Forms 10]
FieldIndices FindFieldIndices(Far::TopologyLevel const& level, std::span<double const> form);

}  // namespace limn::eval
