// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "far_ext/cascade/cascade_level.h"

namespace limn::eval {

/// Volumes that components enclose, by the divergence theorem; quads stand for both of their
/// diagonals, half each.
///
/// Shape   one per component. Meaningful for closed components only.
/// Unit    length^3; negative where faces are clockwise seen from outside.
std::vector<double> MeasureVolumes(far_ext::CascadeMesh const& mesh,
                                   std::span<int const> componentOfVertex, int numComponents,
                                   std::span<double const> positions);

/// Unit normals, 3 per vertex: directions in which the enclosed volume changes most; 0 where it
/// does not.
std::vector<double> FindVolumeNormals(far_ext::CascadeMesh const& mesh,
                                      std::span<double const> positions);

/// Moves vertices until each component encloses what it should: x + c d, with c per component.
///
/// \param componentOfVertex  -1 where a vertex has no face
/// \param isWanted   per component: whether its volume is to be restored
/// \param volumes    per component: what it should be
/// \param directions 3 per vertex
/// \param positions  3 per vertex, changed in place
/// \return           per component: whether its volume is met to 1e-10; others than wanted ones are
/// Source  [Diewald02] Sec. 9 names the aim
std::vector<char> RestoreVolumes(far_ext::CascadeMesh const& mesh,
                                 std::span<int const> componentOfVertex,
                                 std::span<char const> isWanted, std::span<double const> volumes,
                                 std::span<double const> directions, std::span<double> positions);

}  // namespace limn::eval
