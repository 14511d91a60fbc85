// SPDX-License-Identifier: Apache-2.0
#include "engine/images/picture.h"

#include <algorithm>
#include <array>

namespace limn::engine {

namespace {

/// 5 x 7 dots per character, a row per byte, and two more rows for what hangs below the line;
/// enough for numbers, names and units.
struct Glyph {
    char character;
    std::array<uint8_t, 9> rows;
};
constexpr Glyph kFont[] = {{'0', {14, 17, 19, 21, 25, 17, 14}},
                           {'1', {4, 12, 4, 4, 4, 4, 14}},
                           {'2', {14, 17, 1, 2, 4, 8, 31}},
                           {'3', {31, 2, 4, 2, 1, 17, 14}},
                           {'4', {2, 6, 10, 18, 31, 2, 2}},
                           {'5', {31, 16, 30, 1, 1, 17, 14}},
                           {'6', {6, 8, 16, 30, 17, 17, 14}},
                           {'7', {31, 1, 2, 4, 8, 8, 8}},
                           {'8', {14, 17, 17, 14, 17, 17, 14}},
                           {'9', {14, 17, 17, 15, 1, 2, 12}},
                           {'-', {0, 0, 0, 31, 0, 0, 0}},
                           {'+', {0, 4, 4, 31, 4, 4, 0}},
                           {'.', {0, 0, 0, 0, 0, 12, 12}},
                           {' ', {0, 0, 0, 0, 0, 0, 0}},
                           {'#', {10, 10, 31, 10, 31, 10, 10}},
                           {'%', {25, 25, 2, 4, 8, 19, 19}},
                           {'(', {2, 4, 8, 8, 8, 4, 2}},
                           {')', {8, 4, 2, 2, 2, 4, 8}},
                           {',', {0, 0, 0, 0, 0, 12, 12, 4, 8}},
                           {'/', {1, 1, 2, 4, 8, 16, 16}},
                           {':', {0, 12, 12, 0, 12, 12, 0}},
                           {'<', {2, 4, 8, 16, 8, 4, 2}},
                           {'=', {0, 0, 31, 0, 31, 0, 0}},
                           {'>', {8, 4, 2, 1, 2, 4, 8}},
                           {'?', {14, 17, 1, 2, 4, 0, 4}},
                           {'A', {14, 17, 17, 31, 17, 17, 17}},
                           {'B', {30, 17, 17, 30, 17, 17, 30}},
                           {'C', {14, 17, 16, 16, 16, 17, 14}},
                           {'D', {30, 17, 17, 17, 17, 17, 30}},
                           {'E', {31, 16, 16, 30, 16, 16, 31}},
                           {'F', {31, 16, 16, 30, 16, 16, 16}},
                           {'G', {14, 17, 16, 23, 17, 17, 15}},
                           {'H', {17, 17, 17, 31, 17, 17, 17}},
                           {'I', {14, 4, 4, 4, 4, 4, 14}},
                           {'J', {7, 2, 2, 2, 2, 18, 12}},
                           {'K', {17, 18, 20, 24, 20, 18, 17}},
                           {'L', {16, 16, 16, 16, 16, 16, 31}},
                           {'M', {17, 27, 21, 21, 17, 17, 17}},
                           {'N', {17, 25, 21, 19, 17, 17, 17}},
                           {'O', {14, 17, 17, 17, 17, 17, 14}},
                           {'P', {30, 17, 17, 30, 16, 16, 16}},
                           {'Q', {14, 17, 17, 17, 21, 18, 13}},
                           {'R', {30, 17, 17, 30, 20, 18, 17}},
                           {'S', {15, 16, 16, 14, 1, 1, 30}},
                           {'T', {31, 4, 4, 4, 4, 4, 4}},
                           {'U', {17, 17, 17, 17, 17, 17, 14}},
                           {'V', {17, 17, 17, 17, 10, 10, 4}},
                           {'W', {17, 17, 17, 21, 21, 27, 17}},
                           {'X', {17, 17, 10, 4, 10, 17, 17}},
                           {'Y', {17, 17, 10, 4, 4, 4, 4}},
                           {'Z', {31, 1, 2, 4, 8, 16, 31}},
                           {'^', {4, 10, 17, 0, 0, 0, 0}},
                           {'_', {0, 0, 0, 0, 0, 0, 31}},
                           {'a', {0, 0, 14, 1, 15, 17, 15}},
                           {'b', {16, 16, 30, 17, 17, 17, 30}},
                           {'c', {0, 0, 14, 16, 16, 16, 14}},
                           {'d', {1, 1, 15, 17, 17, 17, 15}},
                           {'e', {0, 0, 14, 17, 31, 16, 14}},
                           {'f', {6, 8, 30, 8, 8, 8, 8}},
                           {'g', {0, 0, 15, 17, 17, 17, 15, 1, 14}},
                           {'h', {16, 16, 30, 17, 17, 17, 17}},
                           {'i', {4, 0, 12, 4, 4, 4, 14}},
                           {'j', {2, 0, 6, 2, 2, 2, 2, 18, 12}},
                           {'k', {16, 16, 18, 20, 24, 20, 18}},
                           {'l', {12, 4, 4, 4, 4, 4, 14}},
                           {'m', {0, 0, 26, 21, 21, 21, 21}},
                           {'n', {0, 0, 30, 17, 17, 17, 17}},
                           {'o', {0, 0, 14, 17, 17, 17, 14}},
                           {'p', {0, 0, 30, 17, 17, 17, 30, 16, 16}},
                           {'q', {0, 0, 15, 17, 17, 17, 15, 1, 1}},
                           {'r', {0, 0, 22, 25, 16, 16, 16}},
                           {'s', {0, 0, 15, 16, 14, 1, 30}},
                           {'t', {8, 8, 30, 8, 8, 8, 6}},
                           {'u', {0, 0, 17, 17, 17, 17, 15}},
                           {'v', {0, 0, 17, 17, 17, 10, 4}},
                           {'w', {0, 0, 17, 21, 21, 21, 10}},
                           {'x', {0, 0, 17, 10, 4, 10, 17}},
                           {'y', {0, 0, 17, 17, 17, 17, 15, 1, 14}},
                           {'z', {0, 0, 31, 2, 4, 8, 31}},
                           {'~', {0, 0, 8, 21, 2, 0, 0}}};

/// A question mark where there is none.
Glyph const& FindGlyph(char character) {
    auto const find = [](char c) { return std::ranges::find(kFont, c, &Glyph::character); };
    auto const glyph = find(character);
    return glyph == std::end(kFont) ? *find('?') : *glyph;
}

}  // namespace

std::array<uint8_t, 3> ToBytes(Colour const& colour) {
    std::array<uint8_t, 3> bytes;
    for (size_t c = 0; c < 3; ++c) {
        // lround is a call per channel; what it would mend, 0.5 less an ulp, is no colour.
        // NOLINTNEXTLINE(bugprone-incorrect-roundings)
        bytes[c] = static_cast<uint8_t>(std::clamp(colour[c], 0.0f, 1.0f) * 255.0f + 0.5f);
    }
    return bytes;
}

Picture::Picture(int width, int height)
    : _width(width),
      _height(height),
      _pixels(3 * static_cast<size_t>(width) * static_cast<size_t>(height), kPictureBackground) {}

void Picture::Set(int x, int y, Colour const& colour) {
    if (x < 0 || y < 0 || x >= _width || y >= _height) return;
    std::ranges::copy(ToBytes(colour), &_pixels[3 * (static_cast<size_t>(y) * _width + x)]);
}

void Picture::SetGrey(size_t pixel, uint8_t grey) {
    std::fill_n(&_pixels[3 * pixel], 3, grey);
}

void Picture::Place(int x, int y, Picture const& other) {
    int const width = std::clamp(_width - x, 0, other._width),
              height = std::clamp(_height - y, 0, other._height);
    for (int row = 0; row < height; ++row) {
        std::copy_n(&other._pixels[3 * static_cast<size_t>(row) * other._width],
                    3 * static_cast<size_t>(width),
                    &_pixels[3 * (static_cast<size_t>(y + row) * _width + x)]);
    }
}

void Picture::Write(int x, int y, std::string const& text) {
    for (char character : text) {
        Glyph const& glyph = FindGlyph(character);
        for (int row = 0; row < 18; ++row) {
            for (int column = 0; column < 10; ++column) {
                bool const isSet = glyph.rows[row / 2] >> (4 - column / 2) & 1;
                if (isSet) Set(x + column, y + row, {1, 1, 1});
            }
        }
        x += GetTextWidth(" ");
    }
}

Picture Stack(Picture const& above, Picture const& below) {
    Picture both(std::max(above.GetWidth(), below.GetWidth()),
                 above.GetHeight() + below.GetHeight());
    both.Place(0, 0, above);
    both.Place(0, above.GetHeight(), below);
    return both;
}

}  // namespace limn::engine
