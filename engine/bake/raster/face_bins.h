// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "engine/bake/raster/uv_raster.h"

namespace limn::engine {

/// The faces that may cover a texel, per strip of rows and per block of columns of it.
class FaceBins {
public:
    /// \param bounds    per face
    /// \param isWanted  per face
    FaceBins(std::span<UVBounds const> bounds, std::span<char const> isWanted, TileGrid const& grid,
             int rowsPerStrip, int columnsPerBlock);

    int GetNumStrips() const { return static_cast<int>(_strips.size()); }

    /// Faces in ascending order, for each block of a strip.
    using Blocks = std::vector<std::vector<Index>>;
    Blocks const& GetStrip(int strip) const { return _strips[strip]; }

private:
    std::vector<Blocks> _strips;
};

}  // namespace limn::engine
