// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/strip_packer.h"

#include <algorithm>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "engine/bake/dilate.h"

namespace limn::engine {

namespace {

/// Fills uncovered texels of a strip from the covered ones round them, tile by tile; says in
/// `isFilled` which.
class Padder {
public:
    /// \param isPadded  per plane
    Padder(std::span<std::shared_ptr<Strip> const> window, Strip& strip, int padding,
           std::vector<char> const& isPadded)
        : _strip(strip),
          _isPadded(isPadded),
          _coverage{window.front()->texels.firstRow, strip.texels.width, {}} {
        bool const isAnyCovered = std::any_of(window.begin(), window.end(),
                                              [](auto const& s) { return s->numCovered > 0; });
        _hasWork = padding > 0 && isAnyCovered && strip.numCovered < strip.GetNumTexels();
        if (!_hasWork) return;
        for (auto const& s : window) {
            for (int row = 0; row < s->texels.numRows; ++row) {
                _coverage.rows.push_back(
                    &s->isCovered[static_cast<size_t>(row) * strip.texels.width]);
                _stripOfRow.push_back(s.get());
            }
        }
    }

    bool HasWork() const { return _hasWork; }
    CoverageRows const& GetCoverage() const { return _coverage; }

    void PadTile(PaddingSearch& search, int firstColumn, int numColumns) const {
        TexelStrip const& texels = _strip.texels;
        if (!search.Find(texels.firstRow, texels.numRows, firstColumn, numColumns)) return;
        size_t const width = static_cast<size_t>(texels.width);
        int32_t const* offset = search.GetOffsets().data();
        for (int row = 0; row < texels.numRows; ++row) {
            for (int column = firstColumn; column < firstColumn + numColumns; ++column, ++offset) {
                if (*offset == 0 || *offset == PaddingSearch::kNoSource) continue;
                int const y = row + texels.firstRow + PaddingSearch::GetOffsetY(*offset);
                Strip const& source = *_stripOfRow[y - _coverage.firstRow];
                size_t const to = static_cast<size_t>(row) * width + column;
                size_t const from = static_cast<size_t>(y - source.texels.firstRow) * width +
                                    column + PaddingSearch::GetOffsetX(*offset);
                for (int plane = 0; plane < _strip.numPlanes; ++plane) {
                    if (!_isPadded[plane]) continue;
                    _strip.GetPlane(plane)[to] = source.GetPlane(plane)[from];
                }
                _strip.isFilled[to] = 1;
            }
        }
    }

private:
    Strip& _strip;
    std::vector<char> const& _isPadded;
    CoverageRows _coverage;
    std::vector<Strip const*> _stripOfRow;
    bool _hasWork = false;
};

/// Per plane: all but counts.
std::vector<char> FindPaddedPlanes(std::vector<FileLayout> const& files, int numPlanes) {
    std::vector<char> isPadded(static_cast<size_t>(numPlanes), 1);
    for (FileLayout const& file : files) {
        for (ChannelGroup const& group : file.groups) {
            if (group.averaging != Averaging::Count) continue;
            std::fill_n(isPadded.begin() + file.firstPlane + group.first, group.count, 0);
        }
    }
    return isPadded;
}

void PadStrip(std::span<std::shared_ptr<Strip> const> window, Strip& strip, int padding,
              std::vector<FileLayout> const& files, Job const& job) {
    strip.isFilled = strip.isCovered;
    auto const isPadded = FindPaddedPlanes(files, strip.numPlanes);
    Padder const padder(window, strip, padding, isPadded);
    if (!padder.HasWork()) return;
    constexpr int kTileSize = ExrSpec::kTileSize;
    int const width = strip.texels.width;
    tbb::parallel_for(tbb::blocked_range<int>(0, (width + kTileSize - 1) / kTileSize),
                      [&](auto const& tiles) {
                          job.CheckStopped();
                          PaddingSearch search(padder.GetCoverage(), padding);
                          for (int tile = tiles.begin(); tile != tiles.end(); ++tile) {
                              padder.PadTile(search, tile * kTileSize,
                                             std::min(kTileSize, width - tile * kTileSize));
                          }
                      });
}

}  // namespace

PackedStrip PackStrip(std::span<std::shared_ptr<Strip> const> window, size_t at, int padding,
                      std::vector<FileLayout> const& files,
                      std::vector<std::unique_ptr<TexelSink>> const& sinks, Job const& job) {
    PackedStrip packed;
    packed.strip = window[at];
    Strip& strip = *packed.strip;
    PadStrip(window, strip, padding, files, job);
    if (std::any_of(sinks.begin(), sinks.end(),
                    [](auto const& sink) { return sink && sink->WantsCoverage(); })) {
        packed.coverage.resize(strip.GetNumTexels());
        for (size_t texel = 0; texel < packed.coverage.size(); ++texel) {
            packed.coverage[texel] = strip.GetCoverage(texel);
        }
    }
    packed.outputs.resize(files.size());
    for (size_t f = 0; f < files.size(); ++f) {
        if (!sinks[f]) continue;
        job.CheckStopped();
        int const first = files[f].firstPlane, last = first + files[f].numPlanes;
        PackedStrip::Output& output = packed.outputs[f];
        output.min = *std::min_element(strip.low.begin() + first, strip.low.begin() + last);
        output.max = *std::max_element(strip.high.begin() + first, strip.high.begin() + last);
        output.view = {.index = strip.index,
                       .firstRow = strip.texels.firstRow,
                       .numRows = strip.texels.numRows,
                       .width = strip.texels.width,
                       .planes = strip.GetPlane(first),
                       .planeSize = strip.GetNumTexels(),
                       .coverage = sinks[f]->WantsCoverage() ? packed.coverage.data() : nullptr,
                       .isFilled = strip.isFilled.data()};
        output.rows = sinks[f]->Pack(output.view);
    }
    return packed;
}

}  // namespace limn::engine
