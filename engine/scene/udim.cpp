// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/udim.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace limn::engine {

namespace {

/// How a token writes a tile.
enum class Form { Number, FromOne, FromZero };

struct UdimToken {
    std::string_view text;
    Form form;
};

// Of limn itself, Houdini, Maya and Blender; of Mudbox, whose first tile is u1_v1; of Mari and
// ZBrush, whose first one is u0_v0.
constexpr UdimToken kTokens[] = {{"<UDIM>", Form::Number},    {"{udim}", Form::Number},
                                 {"<udim>", Form::Number},    {"%(UDIM)d", Form::Number},
                                 {"<UVTILE>", Form::FromOne}, {"<uvtile>", Form::FromZero}};

std::string Write(Form form, int number) {
    if (form == Form::Number) return std::to_string(number);
    UdimTile const tile = ToUdimTile(number);
    int const first = form == Form::FromOne ? 1 : 0;
    return fmt::format("u{}_v{}", tile.u + first, tile.v + first);
}

}  // namespace

bool HasUdimToken(std::string_view pattern) {
    return std::ranges::any_of(kTokens, [&](UdimToken const& token) {
        return pattern.find(token.text) != std::string_view::npos;
    });
}

std::string ReplaceUdimToken(std::string pattern, int number) {
    for (UdimToken const& token : kTokens) {
        std::string const value = Write(token.form, number);
        for (size_t at = pattern.find(token.text); at != std::string::npos;
             at = pattern.find(token.text, at + value.size())) {
            pattern.replace(at, token.text.size(), value);
        }
    }
    return pattern;
}

std::optional<std::string> ExpandUdimToken(std::string_view token, int number) {
    auto const found = std::ranges::find(kTokens, token, &UdimToken::text);
    if (found == std::end(kTokens)) return std::nullopt;
    return Write(found->form, number);
}

std::string ListTiles(std::vector<int> const& tiles) {
    constexpr size_t kMost = 20;
    if (tiles.size() <= kMost) return fmt::format("{}", fmt::join(tiles, ", "));
    return fmt::format("{} and {} more", fmt::join(tiles.begin(), tiles.begin() + kMost, ", "),
                       tiles.size() - kMost);
}

std::string ListUdimTokens() {
    std::string list;
    for (UdimToken const& token : kTokens) {
        list += (list.empty() ? "" : ", ") + std::string(token.text);
    }
    return list;
}

}  // namespace limn::engine
