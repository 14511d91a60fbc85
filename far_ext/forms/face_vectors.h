// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/rows/sparse_rows.h"

namespace limn::far_ext {

/// The tangent vector of a 1-form at the middle of each face: three rows (x, y, z) per face over
/// the level's edges.
///
/// Triangles  Whitney's interpolation at the centroid: exact for constant fields.
/// Polygons   the vector in the plane of the area vector that fits the sides best (least squares);
///            the same for constant fields.
/// Without    a plane, as a quad that crosses itself and whose area vector is 0: 0.
/// \param positions  3 per vertex of the level
/// Source            [Wang06] Sec. 4.1; [Forms 8]
SparseRows BuildFaceVectors(Far::TopologyLevel const& level, std::span<double const> positions);

}  // namespace limn::far_ext
