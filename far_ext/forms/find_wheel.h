// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include "far_ext/forms/form_wheel.h"

namespace limn::far_ext {

/// The wheel of a vertex of `level`, with the rules between which OpenSubdiv blends it.
///
/// \param next  the level after; without one sharpness stays as it is: that of the limit, where
///              none fades any more
/// \pre         the vertex has faces
/// Source       [Forms 1], [Forms 5]
Wheel FindWheel(Far::TopologyRefiner const& refiner, Far::TopologyLevel const& level,
                Far::TopologyLevel const* next, Index vertex);

/// p (Loop) or q (Catmull-Clark): what an edge's rule gives to each side beyond its ends.
double FindFaceShare(Far::TopologyRefiner const& refiner, Far::TopologyLevel const& level,
                     Far::TopologyLevel const* next, Index edge);

}  // namespace limn::far_ext
