// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include "far_ext/rows/sparse_rows.h"

namespace limn::far_ext {

/// Kobbelt's interpolating rule on quads, one step: vertices stay, new points lie on four-point
/// curves F(a, b, c, d) = (8 + w)/16 (b + c) - w/16 (a + d) along the lines of the mesh.
///
/// Shape     vertices of `level` x vertices of `level` - 1, in OpenSubdiv's order of a
///           Catmull-Clark refinement
/// Weights   add up to 1 in each row. An edge's point is F of four vertices in line; where a line
///           ends in an irregular vertex it goes on through a virtual point, at a boundary, or a
///           vertex of one face, through the reflection of what comes before. Boundary edges follow
///           the boundary. A face's point is the mean of F over the edge points of the two strips
///           of faces through it.
/// \param refiner  of quads by the Catmull-Clark scheme, refined uniformly to `level` at least
/// \param tension  w
/// \throws Error   BadMesh: an edge with more than two faces, or a vertex where boundaries or
///                 surfaces meet. Unsupported: another scheme, or a face that is no quad
/// Source    [Kobbelt96]; virtual points with t = w/(8 + w), see [Differential 2]
SparseRows BuildKobbelt(Far::TopologyRefiner const& refiner, int level, double tension);

}  // namespace limn::far_ext
