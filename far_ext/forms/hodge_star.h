// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/types.h"

namespace limn::far_ext {

/// The diagonal Hodge stars that designing fields needs: 1-forms weigh `edge` (no unit), 2-forms
/// 1/area.
///
/// Triangles  *1 = (cot a + cot b) / 2 over the angles opposite the edge.
/// Polygons   a side adds |m - c| / |e| (m: its middle, c: mean of the corners) instead of cot/2;
///            the area is that of the fan of triangles from c.
/// Guard      *1 is at least 1e-3 of its mean: negative and vanishing sums (flat pairs of obtuse
///            triangles, squares cut in two) would make the solves indefinite; all identities hold
///            for any positive *1.
/// Source     [Wang06] Sec. 4.2; [Forms 8].
struct HodgeStars {
    std::vector<double> edge;  ///< *1, per edge; positive
    std::vector<double> area;  ///< per face; positive
};

/// \param positions  3 per vertex of the level
/// \throws Error     BadMesh: a face without area, an edge without length (named)
HodgeStars FindHodgeStars(Far::TopologyLevel const& level, std::span<double const> positions);

}  // namespace limn::far_ext
