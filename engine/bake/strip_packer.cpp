// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/strip_packer.h"

#include <algorithm>
#include <cstring>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "engine/bake/dilate.h"

namespace limn::engine {

namespace {

/// Fills uncovered texels of a band from the covered ones round them, tile by tile; says in
/// `isFilled` which.
class Padder {
public:
    Padder(std::span<std::shared_ptr<Band> const> window, Band& band, int padding,
           std::vector<uint8_t>& isFilled)
        : _band(band),
          _isFilled(isFilled),
          _coverage{window.front()->texels.firstRow, band.texels.width, {}} {
        bool const isAnyCovered = std::any_of(window.begin(), window.end(),
                                              [](auto const& b) { return b->numCovered > 0; });
        _hasWork = padding > 0 && isAnyCovered && band.numCovered < band.GetNumTexels();
        if (!_hasWork) return;
        for (auto const& b : window) {
            for (int row = 0; row < b->texels.numRows; ++row) {
                _coverage.rows.push_back(
                    &b->isCovered[static_cast<size_t>(row) * band.texels.width]);
                _bandOfRow.push_back(b.get());
            }
        }
    }

    bool HasWork() const { return _hasWork; }
    CoverageRows const& GetCoverage() const { return _coverage; }

    void PadTile(PaddingSearch& search, int firstColumn, int numColumns) const {
        TexelBand const& texels = _band.texels;
        if (!search.Find(texels.firstRow, texels.numRows, firstColumn, numColumns)) return;
        size_t const numTexels = _band.GetNumTexels(), numPlanes = _band.planes.size() / numTexels;
        size_t const width = static_cast<size_t>(texels.width);
        int32_t const* offset = search.GetOffsets().data();
        for (int row = 0; row < texels.numRows; ++row) {
            for (int column = firstColumn; column < firstColumn + numColumns; ++column, ++offset) {
                if (*offset == 0 || *offset == PaddingSearch::kNoSource) continue;
                int const y = row + texels.firstRow + PaddingSearch::GetOffsetY(*offset);
                Band const& source = *_bandOfRow[y - _coverage.firstRow];
                size_t const to = static_cast<size_t>(row) * width + column;
                size_t const from = static_cast<size_t>(y - source.texels.firstRow) * width +
                                    column + PaddingSearch::GetOffsetX(*offset);
                for (size_t plane = 0; plane < numPlanes; ++plane) {
                    _band.planes[plane * numTexels + to] =
                        source.planes[plane * source.GetNumTexels() + from];
                }
                _isFilled[to] = 1;
            }
        }
    }

private:
    Band& _band;
    std::vector<uint8_t>& _isFilled;
    CoverageRows _coverage;
    std::vector<Band const*> _bandOfRow;
    bool _hasWork = false;
};

bool IsEmpty(std::vector<uint8_t> const& isFilled, size_t width, int firstColumn, int numColumns) {
    size_t const first = static_cast<size_t>(firstColumn);
    size_t const count = std::min(static_cast<size_t>(numColumns), width - first);
    for (size_t row = 0; row < isFilled.size(); row += width) {
        if (std::memchr(&isFilled[row + first], 1, count)) return false;
    }
    return true;
}

}  // namespace

PackedBand PackBand(std::span<std::shared_ptr<Band> const> window, size_t at, int padding,
                    std::vector<FileLayout> const& files,
                    std::vector<std::unique_ptr<ExrWriter>> const& writers, bool hasCoverage,
                    bool needsRows) {
    PackedBand packed;
    packed.band = window[at];
    Band& band = *packed.band;
    packed.index = band.index;
    packed.files.resize(files.size());
    std::vector<uint8_t>& isFilled = band.isFilled;
    isFilled = band.isCovered;
    size_t const width = static_cast<size_t>(band.texels.width), numTexels = band.GetNumTexels();
    int const T = ExrSpec::kTileSize, numTiles = (band.texels.width + T - 1) / T;
    Padder const padder(window, band, padding, isFilled);
    if (padder.HasWork()) {
        tbb::parallel_for(tbb::blocked_range<int>(0, numTiles), [&](auto const& tiles) {
            CheckInterrupted();
            PaddingSearch search(padder.GetCoverage(), padding);
            for (int tile = tiles.begin(); tile != tiles.end(); ++tile) {
                padder.PadTile(search, tile * T, std::min(T, band.texels.width - tile * T));
            }
        });
    }
    std::vector<float>& coverage = packed.coverage;
    if (hasCoverage || needsRows) {
        coverage.resize(numTexels);
        for (size_t texel = 0; texel < numTexels; ++texel)
            coverage[texel] = band.GetCoverage(texel);
    }
    for (size_t f = 0; f < files.size(); ++f) {
        if (!writers[f]) continue;
        FileLayout const& file = files[f];
        PackedBand::File& out = packed.files[f];
        auto const first = file.firstPlane, last = file.firstPlane + file.numPlanes;
        out.min = *std::min_element(band.low.begin() + first, band.low.begin() + last);
        out.max = *std::max_element(band.high.begin() + first, band.high.begin() + last);
        float const* const filePlanes =
            &band.planes[static_cast<size_t>(file.firstPlane) * numTexels];
        out.tiles.resize(static_cast<size_t>(numTiles));
        tbb::parallel_for(0, numTiles, [&](int tile) {
            CheckInterrupted();
            std::vector<float const*> channels;
            if (IsEmpty(isFilled, width, tile * T, T)) {
                out.tiles[tile] = writers[f]->PackEmpty(0, tile, band.index);
                return;
            }
            for (int c = 0; c < file.numPlanes; ++c)
                channels.push_back(filePlanes + c * numTexels + tile * T);
            if (hasCoverage) channels.push_back(coverage.data() + tile * T);
            out.tiles[tile] = writers[f]->Pack(0, tile, band.index, channels.data(), width);
        });
        if (!needsRows) continue;
        for (int row = 0; row < band.texels.numRows; ++row) {
            size_t const texel = static_cast<size_t>(row) * width;
            out.rows.push_back({filePlanes + texel, numTexels, &coverage[texel], &isFilled[texel]});
        }
    }
    return packed;
}

}  // namespace limn::engine
