// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/scene/scene.h"

namespace limn::test {

/// Meshes with semi-sharp creases under Chaikin's rule, no two edges alike, few or many of which
/// meet at a vertex: quads, triangles, polygons, any valence, open and closed, with a hole, and
/// with non-manifold edges. With texture coordinates where the mesh has some.
std::vector<engine::Scene> MakeChaikinMeshes();

}  // namespace limn::test
