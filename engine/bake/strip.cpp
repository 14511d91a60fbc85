// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/strip.h"

#include <algorithm>
#include <limits>

namespace limn::engine {

std::shared_ptr<Strip> StripPool::Acquire(int index, int numPlanes, TileGrid const& grid,
                                          bool countsFaces) {
    std::unique_ptr<Strip> strip;
    {
        std::lock_guard const lock(_mutex);
        if (!_idle.empty()) {
            strip = std::move(_idle.back());
            _idle.pop_back();
        }
    }
    if (!strip) strip = std::make_unique<Strip>();
    strip->index = index;
    strip->numPlanes = numPlanes;
    strip->texels.countsFaces = countsFaces;
    int const firstRow = index * Strip::kRows;
    strip->texels.Resize(firstRow, std::min(Strip::kRows, grid.height - firstRow), grid.width);
    size_t const numTexels = strip->texels.owner.size(), count = static_cast<size_t>(numPlanes);
    strip->planes.resize(numTexels * count);
    strip->isCovered.resize(numTexels);
    strip->coverage.clear();
    strip->low.assign(count, std::numeric_limits<float>::infinity());
    strip->high.assign(count, -std::numeric_limits<float>::infinity());
    strip->numCovered = 0;
    strip->leftOut.clear();
    return {strip.release(), [this](Strip* done) {
                std::unique_ptr<Strip> owned(done);
                std::lock_guard const lock(_mutex);
                _idle.push_back(std::move(owned));
            }};
}

}  // namespace limn::engine
