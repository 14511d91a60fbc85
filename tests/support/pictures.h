// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>

namespace limn::test {

/// A picture, decoded.
struct Picture {
    using Colour = std::array<uint8_t, 3>;

    int width = 0, height = 0;
    std::vector<Colour> pixels;  ///< rows from the top

    Colour const& At(int x, int y) const {
        return pixels.at(static_cast<size_t>(y) * static_cast<size_t>(width) +
                         static_cast<size_t>(x));
    }

    /// The colours in a part of it.
    std::set<Colour> ListColours(int x, int y, int columns, int rows) const {
        std::set<Colour> colours;
        for (int j = y; j < y + rows; ++j) {
            for (int i = x; i < x + columns; ++i) colours.insert(At(i, j));
        }
        return colours;
    }
};

/// \throws std::runtime_error  if it is no whole PNG of three channels of 8 bits
inline Picture ReadPng(std::string const& path) {
    auto const input = OIIO::ImageInput::open(path);
    if (!input) throw std::runtime_error(path + ": " + OIIO::geterror());
    OIIO::ImageSpec const& spec = input->spec();
    if (input->format_name() != std::string("png") || spec.nchannels != 3 ||
        spec.format != OIIO::TypeDesc::UINT8)
        throw std::runtime_error(path + " is no PNG of three bytes a pixel");
    Picture picture{spec.width, spec.height, {}};
    picture.pixels.resize(static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height));
    if (!input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, picture.pixels.data()))
        throw std::runtime_error(path + ": " + input->geterror());
    return picture;
}

}  // namespace limn::test
