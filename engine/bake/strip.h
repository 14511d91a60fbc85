// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "engine/bake/maps/tangential_part.h"
#include "engine/bake/raster/uv_raster.h"
#include "engine/images/exr_writer.h"
#include "far_ext/rows/large_array.h"

namespace limn::engine {

/// A run of texel rows of one tile after evaluation, before padding.
struct Strip {
    static constexpr int kRows = ExrSpec::kTileSize;
    static constexpr int kBlockColumns = 512;  ///< baked together: their values stay in the cache

    int index = 0;  ///< rows [kRows * index, ...)
    TexelStrip texels;
    int numPlanes = 0;
    far_ext::LargeArray<float> planes;  ///< [plane][row][column]; 0 where nothing is covered
    std::vector<uint8_t> isCovered;     ///< [row][column]
    std::vector<uint8_t> isFilled;      ///< [row][column]: covered, or padded by PadStrip
    std::vector<float> coverage;        ///< [row][column], 0 to 1; empty without supersampling
    std::vector<float> low, high;  ///< per plane, over covered texels; low > high if there are none
    size_t numCovered = 0;
    std::vector<TangentialPart> leftOut;  ///< per map

    size_t GetNumTexels() const { return isCovered.size(); }
    float* GetPlane(int plane) { return planes.data() + GetOffset(plane); }
    float const* GetPlane(int plane) const { return planes.data() + GetOffset(plane); }
    float GetCoverage(size_t texel) const {
        return coverage.empty() ? static_cast<float>(isCovered[texel]) : coverage[texel];
    }

private:
    size_t GetOffset(int plane) const { return static_cast<size_t>(plane) * GetNumTexels(); }
};

/// Strips, whose memory is used again once nobody holds them. For many threads; outlives its
/// strips.
class StripPool {
public:
    /// A strip of `numPlanes` planes; no texel has a value yet. \param countsFaces  its texels do
    std::shared_ptr<Strip> Acquire(int index, int numPlanes, TileGrid const& grid,
                                   bool countsFaces);

private:
    std::unique_ptr<Strip> Take();
    void Return(std::unique_ptr<Strip> strip) noexcept;

    std::mutex _mutex;
    size_t _numStrips = 0;
    std::vector<std::unique_ptr<Strip>> _idle;  // with room for all strips
};

/// How many strips a tile has.
inline int CountStrips(int height) {
    return (height + Strip::kRows - 1) / Strip::kRows;
}

}  // namespace limn::engine
