// SPDX-License-Identifier: Apache-2.0
#include "support/pictures.h"

#include <stdexcept>

#include <png.h>

namespace limn::test {

std::set<Picture::Colour> Picture::ListColours(int x, int y, int columns, int rows) const {
    std::set<Colour> colours;
    for (int j = y; j < y + rows; ++j) {
        for (int i = x; i < x + columns; ++i) colours.insert(At(i, j));
    }
    return colours;
}

Picture ReadPng(std::string const& path) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_file(&image, path.c_str()) == 0)
        throw std::runtime_error(path + ": " + image.message);
    if (image.format != PNG_FORMAT_RGB) {
        png_image_free(&image);
        throw std::runtime_error(path + " has not three bytes a pixel");
    }
    Picture picture{static_cast<int>(image.width), static_cast<int>(image.height), {}};
    picture.pixels.resize(size_t{image.width} * image.height);
    if (png_image_finish_read(&image, nullptr, picture.pixels.data(), 0, nullptr) == 0)
        throw std::runtime_error(path + ": " + image.message);
    return picture;
}

}  // namespace limn::test
