// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/strip.h"

#include <algorithm>
#include <limits>

namespace limn::engine {

std::shared_ptr<Strip> StripPool::Acquire(int index, int numPlanes, TileGrid const& grid,
                                          bool countsFaces) {
    std::unique_ptr<Strip> strip = Take();
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
    return {strip.release(), [this](Strip* done) { Return(std::unique_ptr<Strip>(done)); }};
}

std::unique_ptr<Strip> StripPool::Take() {
    std::lock_guard const lock(_mutex);
    if (_idle.empty()) {
        _idle.reserve(++_numStrips);  // now, for a strip may come back where memory is short
        return std::make_unique<Strip>();
    }
    std::unique_ptr<Strip> strip = std::move(_idle.back());
    _idle.pop_back();
    return strip;
}

void StripPool::Return(std::unique_ptr<Strip> strip) noexcept {
    std::lock_guard const lock(_mutex);
    _idle.push_back(std::move(strip));
}

}  // namespace limn::engine
