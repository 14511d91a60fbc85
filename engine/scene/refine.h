// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <opensubdiv/far/topologyRefiner.h>

#include "engine/scene/scene.h"
#include "far_ext/differential/subdivision_rows.h"

namespace limn::engine {

/// Refines a mesh uniformly by OpenSubdiv's rules, in double.
///
/// The result has OpenSubdiv's vertex order, refined UVs and primvars, decayed creases and corners,
/// holes and groups of the parents.
///
/// \param levels  0 to 10
/// \param toLimit also moves the vertices (not the UVs) to their limit
/// \param rule    of the positions; Butterfly needs the Loop scheme, and its vertices are in the
///                limit already
/// \throws Error  BadOption; TooLarge where the refined mesh would pass 2^31 indices
Scene RefineUniformly(Scene const& scene, int levels, bool toLimit,
                      far_ext::SubdivisionRule rule = far_ext::SubdivisionRule::Scheme);

/// A scene's topology, refined uniformly, with the last level's full topology.
///
/// \throws Error  as RefineUniformly
std::unique_ptr<Far::TopologyRefiner> MakeUniformRefiner(Scene const& scene, int levels);

/// Puts faces into the groups of the base faces they lie in.
void InheritGroups(Scene const& scene, std::vector<Index> const& baseFaces, Scene& fine);

/// All of RefineUniformly's result but the positions.
Scene RefineAllButPositions(Scene const& scene, Far::TopologyRefiner const& refiner);

}  // namespace limn::engine
