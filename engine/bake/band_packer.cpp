#include "engine/bake/band_packer.h"

#include <algorithm>
#include <limits>

#include <tbb/parallel_for.h>

#include "engine/bake/dilate.h"

namespace limn::engine {

namespace {

/// Fills the band's uncovered texels from the covered ones round them; returns what is filled.
std::vector<uint8_t> Pad(std::span<std::shared_ptr<Band const> const> window, Band const& band, int padding,
                         std::vector<float>& planes) {
    std::vector<uint8_t> isFilled = band.isCovered;
    bool const isAnyCovered = std::any_of(window.begin(), window.end(), [](auto const& b) {
        return std::find(b->isCovered.begin(), b->isCovered.end(), 1) != b->isCovered.end();
    });
    if (padding == 0 || !isAnyCovered) return isFilled;
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
    size_t const numTexels = band.GetNumTexels(), numPlanes = planes.size() / numTexels;
    for (size_t texel = 0; texel < numTexels; ++texel) {
        if (offsets[texel] == kNoSource || band.isCovered[texel]) continue;
        int const x = static_cast<int>(texel) % width + GetOffsetX(offsets[texel]);
        int const y = static_cast<int>(texel) / width + band.texels.firstRow + GetOffsetY(offsets[texel]);
        Band const& source = *bandOfRow[y - coverage.firstRow];
        size_t const from = static_cast<size_t>(y - source.texels.firstRow) * width + x;
        for (size_t plane = 0; plane < numPlanes; ++plane) {
            planes[plane * numTexels + texel] = source.planes[plane * source.GetNumTexels() + from];
        }
        isFilled[texel] = 1;
    }
    return isFilled;
}

void FindRange(Band const& band, FileLayout const& file, PackedBand::File& packed) {
    packed.min = std::numeric_limits<float>::infinity();
    packed.max = -packed.min;
    size_t const numTexels = band.GetNumTexels();
    for (int plane = file.firstPlane; plane < file.firstPlane + file.numPlanes; ++plane) {
        float const* const values = &band.planes[static_cast<size_t>(plane) * numTexels];
        for (size_t texel = 0; texel < numTexels; ++texel) {
            float const low = band.isCovered[texel] ? values[texel] : packed.min;
            float const high = band.isCovered[texel] ? values[texel] : packed.max;
            packed.min = low < packed.min ? low : packed.min;
            packed.max = high > packed.max ? high : packed.max;
        }
    }
}

}  // namespace

PackedBand PackBand(std::span<std::shared_ptr<Band const> const> window, Band const& band, int padding,
                    std::vector<FileLayout> const& files, std::vector<std::unique_ptr<ExrWriter>> const& writers,
                    bool hasCoverage, bool needsRows) {
    PackedBand packed;
    packed.index = band.index;
    packed.files.resize(files.size());
    std::vector<float> planes = band.planes;
    std::vector<uint8_t> const isFilled = Pad(window, band, padding, planes);
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
        FindRange(band, file, out);
        float const* const filePlanes = &planes[static_cast<size_t>(file.firstPlane) * numTexels];
        out.tiles.resize(static_cast<size_t>(numTiles));
        tbb::parallel_for(0, numTiles, [&](int tile) {
            CheckInterrupted();
            std::vector<float const*> channels;
            for (int c = 0; c < file.numPlanes; ++c) channels.push_back(filePlanes + c * numTexels + tile * T);
            if (hasCoverage) channels.push_back(coverage.data() + tile * T);
            out.tiles[tile] = writers[f]->Pack(0, tile, band.index, channels.data(), width);
        });
        if (!needsRows) continue;
        for (int row = 0; row < band.texels.numRows; ++row) {
            TexelRow texels;
            size_t const first = static_cast<size_t>(row) * width;
            for (int c = 0; c < file.numPlanes; ++c) {
                float const* const from = filePlanes + c * numTexels + first;
                texels.values.insert(texels.values.end(), from, from + width);
            }
            texels.coverage.assign(&coverage[first], &coverage[first] + width);
            texels.isFilled.assign(&isFilled[first], &isFilled[first] + width);
            out.rows.push_back(std::move(texels));
        }
    }
    return packed;
}

}  // namespace limn::engine
