// SPDX-License-Identifier: Apache-2.0
#include "engine/images/exr_lookup.h"

#include <algorithm>
#include <cmath>

#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfTiledInputFile.h>
#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::engine {

struct ExrLookup::File {
    std::unique_ptr<Imf::TiledInputFile> input;
    std::string path;
    std::vector<std::string> channels;
    int width = 0, height = 0, tileSize = 0;
    std::map<std::pair<int, int>, std::vector<float>> tiles;  // [texel][channel]
};

ExrLookup::ExrLookup() = default;
ExrLookup::~ExrLookup() = default;

ExrLookup::File& ExrLookup::Open(std::string const& path,
                                 std::vector<std::string> const& channels) {
    auto& file = _files[path];
    if (file && file->channels == channels) return *file;
    file = std::make_unique<File>();
    file->path = path;
    file->channels = channels;
    try {
        file->input = std::make_unique<Imf::TiledInputFile>(path.c_str());
    } catch (std::exception const& error) {
        throw Error(ErrorCode::Io, fmt::format("'{}' cannot be read back: {}", path, error.what()));
    }
    auto const window = file->input->header().dataWindow();
    file->width = window.max.x + 1;
    file->height = window.max.y + 1;
    file->tileSize = static_cast<int>(file->input->tileXSize());
    return *file;
}

float const* ExrLookup::FetchTexel(File& file, int x, int y) {
    constexpr size_t kMaxTiles = 1024;
    int const T = file.tileSize;
    std::pair const key(x / T, y / T);
    size_t const numChannels = file.channels.size();
    auto found = file.tiles.find(key);
    if (found == file.tiles.end()) {
        if (file.tiles.size() >= kMaxTiles) file.tiles.clear();
        std::vector<float> tile(static_cast<size_t>(T * T) * numChannels, 0.0f);
        Imf::FrameBuffer buffer;
        size_t const pixel = sizeof(float) * numChannels, line = pixel * static_cast<size_t>(T);
        for (size_t c = 0; c < numChannels; ++c) {
            char* const base = reinterpret_cast<char*>(tile.data() + c) -
                               static_cast<ptrdiff_t>(static_cast<size_t>(key.first * T) * pixel) -
                               static_cast<ptrdiff_t>(static_cast<size_t>(key.second * T) * line);
            buffer.insert(file.channels[c], Imf::Slice(Imf::FLOAT, base, pixel, line));
        }
        try {
            file.input->setFrameBuffer(buffer);
            file.input->readTile(key.first, key.second);
        } catch (std::exception const& error) {
            throw Error(ErrorCode::Io,
                        fmt::format("'{}' cannot be read back: {}", file.path, error.what()));
        }
        found = file.tiles.emplace(key, std::move(tile)).first;
    }
    size_t const texel =
        static_cast<size_t>(y % T) * static_cast<size_t>(T) + static_cast<size_t>(x % T);
    return &found->second[texel * numChannels];
}

std::vector<double> ExrLookup::Look(std::string const& path,
                                    std::vector<std::string> const& channels, double x, double y) {
    File& file = Open(path, channels);
    std::vector<double> result(channels.size(), 0.0);
    double const fx = std::floor(x), fy = std::floor(y);
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 2; ++i) {
            double const weight = (i ? x - fx : 1.0 - (x - fx)) * (j ? y - fy : 1.0 - (y - fy));
            if (weight == 0.0) continue;
            int const column = std::clamp(static_cast<int>(fx) + i, 0, file.width - 1);
            int const row = std::clamp(static_cast<int>(fy) + j, 0, file.height - 1);
            float const* const texel = FetchTexel(file, column, row);
            for (size_t c = 0; c < channels.size(); ++c)
                result[c] += weight * static_cast<double>(texel[c]);
        }
    }
    return result;
}

}  // namespace limn::engine
