// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/mip_writer.h"

#include <algorithm>

#include <tbb/parallel_for.h>

namespace limn::engine {

namespace {

constexpr int kTile = ExrSpec::kTileSize;

}  // namespace

MipWriter::MipWriter(ExrWriter& writer, ExrSpec const& spec, std::vector<ChannelGroup> groups,
                     int numPlanes, bool hasCoverage)
    : _writer(writer),
      _spec(spec),
      _numPlanes(numPlanes),
      _hasCoverage(hasCoverage),
      _buffers(static_cast<size_t>(spec.GetNumLevels())),
      _chain(
          spec.width, spec.height, spec.GetNumLevels(), numPlanes, std::move(groups),
          [this](int level, int row, TexelRowView const& texels) { AddRow(level, row, texels); }) {}

void MipWriter::AddRow(int level, int row, TexelRowView const& texels) {
    size_t const width = static_cast<size_t>(_spec.GetLevelWidth(level));
    size_t const planeSize = width * kTile, at = static_cast<size_t>(row % kTile) * width;
    auto& buffer = _buffers[level];
    buffer.resize(planeSize * static_cast<size_t>(_numPlanes + (_hasCoverage ? 1 : 0)));
    for (int c = 0; c < _numPlanes; ++c) {
        std::copy_n(texels.values + c * texels.stride, width, &buffer[c * planeSize + at]);
    }
    if (_hasCoverage) std::copy_n(texels.coverage, width, &buffer[_numPlanes * planeSize + at]);
    bool const isComplete = row % kTile == kTile - 1 || row == _spec.GetLevelHeight(level) - 1;
    if (isComplete) WriteTiles(level, row / kTile);
}

/// \param row  of tiles
void MipWriter::WriteTiles(int level, int row) {
    int const width = _spec.GetLevelWidth(level);
    auto const& buffer = _buffers[level];
    size_t const planeSize = static_cast<size_t>(width) * kTile;
    std::vector<ExrTile> tiles(static_cast<size_t>((width + kTile - 1) / kTile));
    tbb::parallel_for(size_t{0}, tiles.size(), [&](size_t tile) {
        std::vector<float const*> channels;
        for (size_t plane = 0; plane < buffer.size(); plane += planeSize) {
            channels.push_back(&buffer[plane + tile * kTile]);
        }
        tiles[tile] = _writer.Pack(level, static_cast<int>(tile), row, channels.data(),
                                   static_cast<size_t>(width));
    });
    for (ExrTile const& tile : tiles) {
        _numClamped += tile.numClamped;
        _writer.Write(tile);
    }
}

}  // namespace limn::engine
