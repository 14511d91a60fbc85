// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "far_ext/types.h"

namespace limn::eval {

/// A mesh of triangles, and where it stands for a smooth surface.
struct SagittaMesh {
    std::span<Index const> faces;       ///< 3 corners per triangle
    std::span<double const> positions;  ///< 3 per vertex
    std::span<double const> reach;      ///< per triangle: how far the surface may lie from it
    std::span<std::array<Index, 2> const> creases;  ///< edges that stay sharp
};

/// How far each triangle lies from the smooth surface through its corners, about: the largest over
/// its edges of
///
///     along    |(n_b - n_a).(x_b - x_a)| / 8, n area-weighted normals of vertices
///     across   the rise of an arc that turns by the dihedral angle theta over a chord h, the mean
///              of both triangles' heights: tan(theta/4) h/2, or theta h/8 where theta is small
///
/// and no more than the larger reach of the edge's triangles.
///
/// Shape   one per triangle. Unit: length.
/// Source  [Cascade 13]
std::vector<double> FindSagittas(SagittaMesh const& mesh);

}  // namespace limn::eval
