// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/raster/face_bins.h"

#include <algorithm>

namespace limn::engine {

FaceBins::FaceBins(std::span<UVBounds const> bounds, std::span<char const> isWanted,
                   TileGrid const& grid, int rowsPerStrip, int columnsPerBlock) {
    auto const count = [](int size, int part) {
        return static_cast<size_t>((size + part - 1) / part);
    };
    _strips.assign(count(grid.height, rowsPerStrip), Blocks(count(grid.width, columnsPerBlock)));
    for (size_t face = 0; face < bounds.size(); ++face) {
        if (!isWanted[face]) continue;
        UVBounds const& b = bounds[face];
        // Samples lie up to half a texel beside a texel's centre, and a face covers 1e-4 beyond it.
        double const slack = 1.0;
        double const left = grid.ToX(b.minU) - slack, right = grid.ToX(b.maxU) + slack;
        double const top = grid.ToY(b.maxV) - slack, bottom = grid.ToY(b.minV) + slack;
        double const lastX = grid.width - 1.0, lastY = grid.height - 1.0;
        if (!(right >= 0.0 && left <= lastX && bottom >= 0.0 && top <= lastY)) continue;
        int const firstBlock = static_cast<int>(std::max(left, 0.0)) / columnsPerBlock;
        int const lastBlock = static_cast<int>(std::min(right, lastX)) / columnsPerBlock;
        int const firstStrip = static_cast<int>(std::max(top, 0.0)) / rowsPerStrip;
        int const lastStrip = static_cast<int>(std::min(bottom, lastY)) / rowsPerStrip;
        for (int strip = firstStrip; strip <= lastStrip; ++strip) {
            for (int block = firstBlock; block <= lastBlock; ++block) {
                _strips[strip][block].push_back(static_cast<Index>(face));
            }
        }
    }
}

}  // namespace limn::engine
