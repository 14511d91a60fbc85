// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/options/bake_values.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include "engine/cli/options/number.h"
#include "far_ext/error.h"

namespace limn::cli {

engine::Encoding ParseEncoding(std::string const& text) {
    size_t const comma = text.find(',');
    if (comma == std::string::npos) {
        throw Error(ErrorCode::BadOption, "--encode: scale,offset is needed, e.g. 0.5,0.5");
    }
    engine::Encoding const encoding{
        ParseNumber<double>("--encode", std::string_view(text).substr(0, comma)),
        ParseNumber<double>("--encode", std::string_view(text).substr(comma + 1))};
    if (encoding.scale == 0.0) {
        throw Error(
            ErrorCode::BadOption,
            fmt::format("--encode: '{}' has the scale 0, which makes all values equal", text));
    }
    return encoding;
}

engine::Origin ParseOrigin(std::string const& text) {
    if (text == "auto") return engine::AutomaticOrigin{};
    if (std::ranges::count(text, ',') != 2) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("--origin: '{}' is neither X,Y,Z nor auto", text));
    }
    std::array<double, 3> point{};
    std::istringstream words(text);
    for (double& coordinate : point) {
        std::string word;
        std::getline(words, word, ',');
        coordinate = ParseNumber<double>("--origin", word);
    }
    return point;
}

std::vector<int> ParseTiles(std::vector<std::string> const& texts) {
    std::vector<int> tiles;
    for (std::string const& text : texts) {
        size_t const dash = text.find('-');
        auto const parse = [](std::string_view part, int low) {
            return ParseNumber<int>("--tiles", part, {low, 9999});
        };
        int const first = parse(std::string_view(text).substr(0, dash), 1001);
        int const last = dash == std::string::npos
                             ? first
                             : parse(std::string_view(text).substr(dash + 1), first);
        for (int tile = first; tile <= last; ++tile) tiles.push_back(tile);
    }
    return tiles;
}

std::vector<std::string> ParseHalfMaps(std::string const& text,
                                       std::vector<std::string> const& maps) {
    std::vector<std::string> listed;
    if (text == kAllMaps) return listed;
    std::istringstream words(text);
    for (std::string map; std::getline(words, map, ',');) {
        if (std::ranges::find(maps, map) == maps.end()) {
            throw Error(ErrorCode::BadOption,
                        fmt::format("--half={}: '{}' is no map that is baked", text, map));
        }
        listed.push_back(map);
    }
    return listed;
}

}  // namespace limn::cli
