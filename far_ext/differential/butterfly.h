// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include "far_ext/rows/sparse_rows.h"

namespace limn::far_ext {

/// Modified Butterfly, one step: vertices stay, a new vertex per edge is a weighted mean of
/// vertices around.
///
/// Shape     vertices of `level` x vertices of `level` - 1, in OpenSubdiv's order of a Loop
///           refinement
/// Weights   add up to 1 in each row. Regular edges 1/2, 1/8, -1/16; an irregular end of valence K
///           weighs its ring by (1/4 + cos(2 pi j/K) + cos(4 pi j/K)/2)/K and itself by 3/4 (K = 3,
///           4: as published), two irregular ends count half each; boundary edges (-1, 9, 9,
///           -1)/16. A wing that would lie across a boundary edge (p, c) of triangle (p, q, c) is p
///           + c - q.
/// \param refiner  of triangles by the Loop scheme, refined uniformly to `level` at least
/// \throws Error   BadMesh: an edge with more than two faces, or a vertex where boundaries meet.
///                 Unsupported: another scheme
/// Source    [Zhu11] Sec. 3.2 (modified Butterfly)
SparseRows BuildButterfly(Far::TopologyRefiner const& refiner, int level);

/// The original Butterfly, one step: the same mask at every valence.
///
/// Shape     that of BuildButterfly
/// Weights   add up to 1 in each row. Edges 1/2 on both ends, 2w on both opposite vertices, -w on
///           the four wings; boundary edges (-w, 1/2 + w, 1/2 + w, -w). w = 1/16 is the modified
///           rule where valences are 6.
/// \param tension  w
/// \throws Error   as BuildButterfly
/// Source    [Zhu11] Sec. 3.2 (Butterfly)
SparseRows BuildOriginalButterfly(Far::TopologyRefiner const& refiner, int level, double tension);

}  // namespace limn::far_ext
