// SPDX-License-Identifier: Apache-2.0
#include "engine/images/picture.h"

#include <algorithm>
#include <array>

namespace limn::engine {

namespace {

constexpr uint8_t kBackground = 38;

/// 5 x 7 dots per character, a row per byte; enough for numbers and units.
struct Glyph {
    char character;
    std::array<uint8_t, 7> rows;
};
constexpr Glyph kFont[] = {{'0', {14, 17, 19, 21, 25, 17, 14}}, {'1', {4, 12, 4, 4, 4, 4, 14}},
                           {'2', {14, 17, 1, 2, 4, 8, 31}},     {'3', {31, 2, 4, 2, 1, 17, 14}},
                           {'4', {2, 6, 10, 18, 31, 2, 2}},     {'5', {31, 16, 30, 1, 1, 17, 14}},
                           {'6', {6, 8, 16, 30, 17, 17, 14}},   {'7', {31, 1, 2, 4, 8, 8, 8}},
                           {'8', {14, 17, 17, 14, 17, 17, 14}}, {'9', {14, 17, 17, 15, 1, 2, 12}},
                           {'-', {0, 0, 0, 31, 0, 0, 0}},       {'+', {0, 4, 4, 31, 4, 4, 0}},
                           {'.', {0, 0, 0, 0, 0, 12, 12}},      {'e', {0, 0, 14, 17, 31, 16, 14}}};

}  // namespace

Picture::Picture(int width, int height)
    : _width(width),
      _height(height),
      _pixels(3 * static_cast<size_t>(width) * static_cast<size_t>(height), kBackground) {}

void Picture::Set(int x, int y, Colour const& colour) {
    if (x < 0 || y < 0 || x >= _width || y >= _height) return;
    uint8_t* const pixel = &_pixels[3 * (static_cast<size_t>(y) * _width + x)];
    for (size_t c = 0; c < 3; ++c) {
        pixel[c] = static_cast<uint8_t>(std::clamp(colour[c], 0.0f, 1.0f) * 255.0f + 0.5f);
    }
}

void Picture::SetGrey(size_t pixel, uint8_t grey) {
    std::fill_n(&_pixels[3 * pixel], 3, grey);
}

void Picture::Write(int x, int y, std::string const& text) {
    for (char character : text) {
        auto const glyph = std::find_if(std::begin(kFont), std::end(kFont),
                                        [&](Glyph const& g) { return g.character == character; });
        for (int row = 0; glyph != std::end(kFont) && row < 14; ++row) {
            for (int column = 0; column < 10; ++column) {
                bool const isSet = glyph->rows[row / 2] >> (4 - column / 2) & 1;
                if (isSet) Set(x + column, y + row, {1, 1, 1});
            }
        }
        x += GetTextWidth(" ");
    }
}

}  // namespace limn::engine
