// SPDX-License-Identifier: Apache-2.0
#include "engine/images/exr_rows.h"

#include <algorithm>

#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfTiledInputFile.h>
#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::engine {

struct ExrRows::File {
    Imf::TiledInputFile input;
};

namespace {

[[noreturn]] void ThrowReadError(std::string const& path, char const* reason) {
    throw Error(ErrorCode::Io, fmt::format("'{}' cannot be read back: {}", path, reason));
}

}  // namespace

ExrRows::ExrRows(std::string const& path, std::vector<std::string> const& channels)
    : _path(path), _channels(channels) {
    try {
        _file.reset(new File{Imf::TiledInputFile(path.c_str())});
        auto const window = _file->input.header().dataWindow();
        _width = window.max.x + 1;
        _tileRows = static_cast<int>(_file->input.tileYSize());
    } catch (std::exception const& error) {
        ThrowReadError(path, error.what());
    }
    _values.resize(channels.size() * static_cast<size_t>(_width) * _tileRows);
}

ExrRows::~ExrRows() = default;

void ExrRows::ReadTiles(int row) {
    size_t const width = static_cast<size_t>(_width), planeSize = width * _tileRows;
    _firstRow = row / _tileRows * _tileRows;
    Imf::FrameBuffer buffer;
    for (size_t c = 0; c < _channels.size(); ++c) {
        // OpenEXR counts from the image's first texel.
        float* const base = _values.data() + c * planeSize - static_cast<size_t>(_firstRow) * width;
        buffer.insert(_channels[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(base),
                                               sizeof(float), sizeof(float) * width));
    }
    try {
        _file->input.setFrameBuffer(buffer);
        int const tile = row / _tileRows;
        _file->input.readTiles(0, _file->input.numXTiles() - 1, tile, tile);
    } catch (std::exception const& error) {
        ThrowReadError(_path, error.what());
    }
    _numRows = _tileRows;
}

float const* ExrRows::GetRow(int row, size_t channel) {
    if (row < _firstRow || row >= _firstRow + _numRows) ReadTiles(row);
    size_t const planeSize = static_cast<size_t>(_width) * _tileRows;
    return &_values[channel * planeSize + static_cast<size_t>(row - _firstRow) * _width];
}

}  // namespace limn::engine
