// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

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
    std::set<Colour> ListColours(int x, int y, int columns, int rows) const;
};

/// \throws std::runtime_error  if it is no whole PNG of three channels of 8 bits
Picture ReadPng(std::string const& path);

}  // namespace limn::test
