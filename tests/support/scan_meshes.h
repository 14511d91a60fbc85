// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/scene/scene.h"

namespace limn::test {

/// Triangles as a scan has them: side^2 points, scattered over the unit square, joined by
/// Delaunay's rule, on a gently bent height field. Valences 3 to 11, a third of them 6, so that few
/// faces are regular. Texture coordinates are x and y. A Loop cage.
engine::Scene MakeScan(int side, unsigned seed = 5);

}  // namespace limn::test
