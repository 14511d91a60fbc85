// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/images/colours.h"

namespace limn::engine {

/// Every channel of what is nothing in particular.
inline constexpr uint8_t kPictureBackground = 38;

std::array<uint8_t, 3> ToBytes(Colour const& colour);

/// An RGB picture, 8 bits a channel, rows from the top.
class Picture {
public:
    /// Dark grey all over.
    Picture(int width, int height);

    int GetWidth() const { return _width; }
    int GetHeight() const { return _height; }
    uint8_t const* GetPixels() const { return _pixels.data(); }  ///< [row][column][3]

    void Set(int x, int y, Colour const& colour);  ///< nothing outside the picture
    void SetGrey(size_t pixel, uint8_t grey);      ///< pixel = y * width + x

    /// Puts another picture into this one, its upper left pixel at (x, y).
    void Place(int x, int y, Picture const& other);

    /// Writes ASCII text, white, 14 pixels high; some letters hang 4 lower.
    void Write(int x, int y, std::string const& text);
    static int GetTextWidth(std::string const& text) { return 12 * static_cast<int>(text.size()); }

private:
    int _width, _height;
    std::vector<uint8_t> _pixels;
};

/// One picture above another.
Picture Stack(Picture const& above, Picture const& below);

}  // namespace limn::engine
