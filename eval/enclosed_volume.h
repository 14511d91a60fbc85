#pragma once

#include <span>
#include <vector>

#include "far_ext/cascade_level.h"

namespace limn::eval {

/// Volumes that components enclose, by the divergence theorem; quads stand for both of their diagonals, half each.
///
/// Shape   one per component. Meaningful for closed components only.
/// Unit    length^3; negative where faces are clockwise seen from outside.
std::vector<double> MeasureVolumes(far_ext::CascadeMesh const& mesh, std::span<int const> componentOfVertex, int numComponents,
                                   std::span<double const> positions);

/// Moves vertices along their normals until each component encloses what it should: x + c reach n, with c per component.
/// With a reach of sigma^2 / 2 this is the constraint force of curvature motion under constant volume.
///
/// \param componentOfVertex  -1 where a vertex has no face and no reach
/// \param reach      per vertex: 0 where it stays
/// \param isWanted   per component: whether its volume is to be restored
/// \param volumes    per component: what it should be
/// \param positions  3 per vertex, changed in place
/// \return           per component: whether its volume is met to 1e-10; others than wanted ones are
/// Source  [Diewald02] Sec. 9 names the aim
std::vector<char> RestoreVolumes(far_ext::CascadeMesh const& mesh, std::span<int const> componentOfVertex, std::span<char const> isWanted,
                                 std::span<double const> volumes, std::span<double const> reach, std::span<double> positions);

}  // namespace limn::eval
