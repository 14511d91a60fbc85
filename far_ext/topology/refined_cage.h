// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "far_ext/topology/control_mesh.h"
#include "far_ext/types.h"

namespace limn::far_ext {

/// The last level of a uniform refinement as a cage of its own, with the same limit surface: its
/// faces, face-varying channels, holes, and what is left of creases and corners.
///
/// \param refiner  uniformly refined, with the last level's full topology
/// \param base     the cage the refiner was made from: gives scheme and options
ControlMesh MakeRefinedCage(Far::TopologyRefiner const& refiner, ControlMesh const& base);

/// The base face that each face of a level of a uniform refinement lies in.
std::vector<Index> FindBaseFaces(Far::TopologyRefiner const& refiner, int level);

}  // namespace limn::far_ext
