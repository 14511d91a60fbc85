// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledInputFile.h>
#include <OpenEXR/ImfTiledOutputFile.h>

namespace limn::bench {

/// An image of three half channels, plane by plane.
struct HalfImage {
    static constexpr std::array<char const*, 3> kChannels{"R", "G", "B"};

    int width = 0, height = 0;
    std::array<std::vector<half>, 3> planes;

    bool operator==(HalfImage const& other) const {
        auto const isSame = [](std::vector<half> const& a, std::vector<half> const& b) {
            return a.size() == b.size() &&
                   std::memcmp(a.data(), b.data(), a.size() * sizeof(half)) == 0;
        };
        return width == other.width && height == other.height &&
               isSame(planes[0], other.planes[0]) && isSame(planes[1], other.planes[1]) &&
               isSame(planes[2], other.planes[2]);
    }

    Imf::FrameBuffer GetFrameBuffer() {
        Imf::FrameBuffer buffer;
        for (size_t c = 0; c < planes.size(); ++c) {
            buffer.insert(kChannels[c],
                          Imf::Slice(Imf::HALF, reinterpret_cast<char*>(planes[c].data()),
                                     sizeof(half), sizeof(half) * static_cast<size_t>(width)));
        }
        return buffer;
    }
};

/// The largest level of a tiled file, whoever wrote it.
inline HalfImage ReadTiledExr(std::string const& path) {
    Imf::TiledInputFile file(path.c_str(), 0);
    HalfImage image;
    image.width = file.levelWidth(0);
    image.height = file.levelHeight(0);
    for (auto& plane : image.planes)
        plane.resize(static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
    file.setFrameBuffer(image.GetFrameBuffer());
    file.readTiles(0, file.numXTiles(0) - 1, 0, file.numYTiles(0) - 1);
    return image;
}

/// OpenEXR's own writer: ZIP, tiles of 64 x 64, one level.
inline void WriteTiledExr(std::string const& path, HalfImage& image, int numThreads) {
    int const numWorkers =
        numThreads == 1 ? 0 : numThreads;  // OpenEXR's 0 is "in the caller's thread"
    Imf::setGlobalThreadCount(numWorkers);
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.setTileDescription(Imf::TileDescription(64, 64, Imf::ONE_LEVEL));
    for (char const* channel : HalfImage::kChannels)
        header.channels().insert(channel, Imf::Channel(Imf::HALF));
    Imf::TiledOutputFile file(path.c_str(), header, numWorkers);
    file.setFrameBuffer(image.GetFrameBuffer());
    file.writeTiles(0, file.numXTiles(0) - 1, 0, file.numYTiles(0) - 1);
}

}  // namespace limn::bench
