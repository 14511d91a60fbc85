// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limn::engine {

// UDIM, the numbering of texture tiles: the unit square at column u (0 to 9) and row v (0 and up)
// of texture space is tile 1001 + u + 10 v.

/// A tile as column and row of texture space.
struct UdimTile {
    int u = 0, v = 0;

    constexpr int GetNumber() const { return 1001 + u + 10 * v; }
};

/// \pre number >= 1001
constexpr UdimTile ToUdimTile(int number) {
    return {(number - 1001) % 10, (number - 1001) / 10};
}

inline constexpr int kMaxUdimRows = 900;  ///< a number has four digits

/// The tile that (u, v) lies in; none outside the range of UDIM.
inline std::optional<UdimTile> FindUdimTile(double u, double v) {
    bool const isInRange = u >= 0.0 && u < 10.0 && v >= 0.0 && v < kMaxUdimRows;
    if (!isInRange) return std::nullopt;  // NaN comes here, too
    return UdimTile{static_cast<int>(u), static_cast<int>(v)};
}

/// Whether a path names its tile, by one of the spellings that ListUdimTokens lists.
bool HasUdimToken(std::string_view pattern);
/// The path with the tile in place of each of these. \pre number >= 1001
std::string ReplaceUdimToken(std::string pattern, int number);

/// What a token stands for in a tile; none if it is no token of UDIM. \pre number >= 1001
std::optional<std::string> ExpandUdimToken(std::string_view token, int number);

/// "1001, 1002", and no more than a line of them.
std::string ListTiles(std::vector<int> const& tiles);

/// "<UDIM>, {udim}, ..."
std::string ListUdimTokens();

}  // namespace limn::engine
