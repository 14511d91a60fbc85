#include "engine/bake/band_packer.h"

#include <algorithm>
#include <cstring>

#include <tbb/parallel_for.h>

#include "engine/bake/dilate.h"

namespace limn::engine {

namespace {

/// Fills the band's uncovered texels from the covered ones round them; returns what is filled.
std::vector<uint8_t> Pad(std::span<std::shared_ptr<Band> const> window, Band& band, int padding) {
    std::vector<uint8_t> isFilled = band.isCovered;
    bool const isAnyCovered =
        std::any_of(window.begin(), window.end(), [](auto const& b) { return !b->low.empty() && b->low[0] <= b->high[0]; });
    bool const isAllCovered = std::memchr(band.isCovered.data(), 0, band.isCovered.size()) == nullptr;
    if (padding == 0 || !isAnyCovered || isAllCovered) return isFilled;
    int const width = band.texels.width;
    CoverageRows coverage{window.front()->texels.firstRow, width, {}};
    std::vector<Band const*> bandOfRow;
    for (auto const& b : window) {
        for (int row = 0; row < b->texels.numRows; ++row) {
            coverage.rows.push_back(&b->isCovered[static_cast<size_t>(row) * width]);
            bandOfRow.push_back(b.get());
        }
    }
    auto const offsets = FindPadding(coverage, band.texels.firstRow, band.texels.numRows, padding);
    size_t const numTexels = band.GetNumTexels(), numPlanes = band.planes.size() / numTexels;
    size_t texel = 0;
    for (int row = 0; row < band.texels.numRows; ++row) {
        for (int column = 0; column < width; ++column, ++texel) {
            int32_t const offset = offsets[texel];
            if (offset == 0 || offset == kNoSource) continue;
            int const y = row + band.texels.firstRow + GetOffsetY(offset);
            Band const& source = *bandOfRow[y - coverage.firstRow];
            size_t const from = static_cast<size_t>(y - source.texels.firstRow) * width + column + GetOffsetX(offset);
            for (size_t plane = 0; plane < numPlanes; ++plane) {
                band.planes[plane * numTexels + texel] = source.planes[plane * source.GetNumTexels() + from];
            }
            isFilled[texel] = 1;
        }
    }
    return isFilled;
}

bool IsEmpty(std::vector<uint8_t> const& isFilled, size_t width, int firstColumn, int numColumns) {
    size_t const first = static_cast<size_t>(firstColumn);
    size_t const count = std::min(static_cast<size_t>(numColumns), width - first);
    for (size_t row = 0; row < isFilled.size(); row += width) {
        if (std::memchr(&isFilled[row + first], 1, count)) return false;
    }
    return true;
}

}  // namespace

PackedBand PackBand(std::span<std::shared_ptr<Band> const> window, Band& band, int padding,
                    std::vector<FileLayout> const& files, std::vector<std::unique_ptr<ExrWriter>> const& writers,
                    bool hasCoverage, bool needsRows) {
    PackedBand packed;
    packed.index = band.index;
    packed.files.resize(files.size());
    std::vector<uint8_t> const isFilled = Pad(window, band, padding);
    size_t const width = static_cast<size_t>(band.texels.width), numTexels = band.GetNumTexels();
    int const T = ExrSpec::kTileSize, numTiles = (band.texels.width + T - 1) / T;
    std::vector<float> coverage;
    if (hasCoverage || needsRows) {
        coverage.resize(numTexels);
        for (size_t texel = 0; texel < numTexels; ++texel) coverage[texel] = band.GetCoverage(texel);
    }
    for (size_t f = 0; f < files.size(); ++f) {
        if (!writers[f]) continue;
        FileLayout const& file = files[f];
        PackedBand::File& out = packed.files[f];
        auto const first = file.firstPlane, last = file.firstPlane + file.numPlanes;
        out.min = *std::min_element(band.low.begin() + first, band.low.begin() + last);
        out.max = *std::max_element(band.high.begin() + first, band.high.begin() + last);
        float const* const filePlanes = &band.planes[static_cast<size_t>(file.firstPlane) * numTexels];
        out.tiles.resize(static_cast<size_t>(numTiles));
        tbb::parallel_for(0, numTiles, [&](int tile) {
            CheckInterrupted();
            std::vector<float const*> channels;
            if (IsEmpty(isFilled, width, tile * T, T)) {
                out.tiles[tile] = writers[f]->PackEmpty(0, tile, band.index);
                return;
            }
            for (int c = 0; c < file.numPlanes; ++c) channels.push_back(filePlanes + c * numTexels + tile * T);
            if (hasCoverage) channels.push_back(coverage.data() + tile * T);
            out.tiles[tile] = writers[f]->Pack(0, tile, band.index, channels.data(), width);
        });
        if (!needsRows) continue;
        for (int row = 0; row < band.texels.numRows; ++row) {
            TexelRow texels;
            size_t const at = static_cast<size_t>(row) * width;
            for (int c = 0; c < file.numPlanes; ++c) {
                float const* const from = filePlanes + c * numTexels + at;
                texels.values.insert(texels.values.end(), from, from + width);
            }
            texels.coverage.assign(&coverage[at], &coverage[at] + width);
            texels.isFilled.assign(&isFilled[at], &isFilled[at] + width);
            out.rows.push_back(std::move(texels));
        }
    }
    return packed;
}

}  // namespace limn::engine
