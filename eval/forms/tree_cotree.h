// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/types.h"

namespace limn::eval {

/// A basis of the closed 1-forms that are no gradients: 2 g + max(b - 1, 0) per component of genus
/// g with b boundary loops. Each is 1 on one generator (an edge in neither a spanning tree of the
/// vertices nor one of the faces), 0 on the other generators and on the vertices' tree; the faces'
/// tree gives the rest.
///
/// \param isRelative  forms that vanish on boundary edges (a field normal to the boundary) rather
///                    than any
/// Order    generators by their edge. A form has integers only, mostly 0 and 1.
/// Source   [Eppstein03]; [Forms 9].
std::vector<std::vector<double>> FindClosedForms(Far::TopologyLevel const& level, bool isRelative);

}  // namespace limn::eval
