// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/scene/model.h"

namespace limn::engine {

/// What texture coordinates look like to a bake.
struct UVInfo {
    bool present = false;
    std::vector<int> tiles;   ///< UDIM numbers, in order: those a bake of 2048 x 2048 finds
    size_t overlapFaces = 0;  ///< whose polygon lies over another's
    size_t flippedFaces = 0, zeroAreaFaces = 0, outOfRangeFaces = 0;
    size_t bareFaces = 0;  ///< without texture coordinates, beside others that have some
};

/// Per face: whether it has texture coordinates, and its polygon there has no area.
std::vector<char> FindFlatFaces(Model const& model);

/// Looks at the polygons that faces are in texture space, and for tiles and range at their limit.
/// Those that lie over others are found on a grid of 512 x 512 samples per tile; a bake counts
/// texels instead (BakeReport::overlaps).
UVInfo DescribeUVs(Model const& model);

}  // namespace limn::engine
