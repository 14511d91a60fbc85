// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "far_ext/rings/face_ring.h"
#include "far_ext/rows/sparse_rows.h"

namespace limn::far_ext {

/// The limit point of one corner of a ring's face, as weights over the ring's points: the rule for
/// vertices that no closed form covers (semi-sharp creases and corners, darts, non-manifold
/// vertices).
///
/// Far's own rules do the weights: the ring is subdivided towards the corner until it repeats
/// itself; what is left is one stationary matrix, whose high power maps every point to the limit.
///
/// \param ring    vertex topology
/// \param corner  of the ring's face 0
/// \return        weights that add up to 1, rounding aside
/// \throws Error  BadMesh where OpenSubdiv refuses the topology
WeightRow BuildCornerLimit(FaceRing const& ring, int corner, Sdc::SchemeType scheme,
                           Sdc::Options options);

}  // namespace limn::far_ext
