// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/scene/model.h"

namespace limn::engine {

/// What texture coordinates look like to a bake.
struct UVInfo {
    bool present = false;
    std::vector<int> tiles;  ///< UDIM numbers, in order
    size_t overlapFaces = 0, flippedFaces = 0, zeroAreaFaces = 0, outOfRangeFaces = 0;
};

/// Looks at the polygons that faces are in texture space. Those that overlap are found on a grid of
/// 512 x 512 samples per tile.
UVInfo DescribeUVs(Model const& model);

}  // namespace limn::engine
