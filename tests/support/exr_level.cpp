// SPDX-License-Identifier: Apache-2.0
#include "support/exr_level.h"

#include <OpenEXR/ImfFrameBuffer.h>

namespace limn::test {

std::vector<float> ReadLevel(Imf::TiledInputFile& input, int level,
                             std::vector<std::string> const& channels) {
    auto const width = static_cast<size_t>(input.levelWidth(level)),
               height = static_cast<size_t>(input.levelHeight(level));
    size_t const pixelBytes = channels.size() * sizeof(float);
    std::vector<float> pixels(channels.size() * width * height);
    Imf::FrameBuffer buffer;
    for (size_t c = 0; c < channels.size(); ++c) {
        buffer.insert(channels[c],
                      Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels.data() + c), pixelBytes,
                                 pixelBytes * width));
    }
    input.setFrameBuffer(buffer);
    input.readTiles(0, input.numXTiles(level) - 1, 0, input.numYTiles(level) - 1, level);
    return pixels;
}

}  // namespace limn::test
