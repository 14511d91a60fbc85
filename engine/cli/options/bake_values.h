// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/bake/maps/map_options.h"

namespace limn::cli {

/// Of --encode: "scale,offset". \throws Error BadOption
engine::Encoding ParseEncoding(std::string const& text);

/// Of --origin: "X,Y,Z" or "auto". \throws Error BadOption
engine::Origin ParseOrigin(std::string const& text);

/// Of --tiles: numbers, or ranges as "1003-1005". \throws Error BadOption
std::vector<int> ParseTiles(std::vector<std::string> const& texts);

inline constexpr char const* kAllMaps = "all";

/// Of --half: the maps that it lists; none of kAllMaps.
///
/// \param maps    that are baked
/// \throws Error  BadOption: another map
std::vector<std::string> ParseHalfMaps(std::string const& text,
                                       std::vector<std::string> const& maps);

}  // namespace limn::cli
