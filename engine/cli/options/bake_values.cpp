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

}  // namespace limn::cli
