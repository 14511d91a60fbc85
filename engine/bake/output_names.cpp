// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/output_names.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/images/exr_writer.h"
#include "engine/io/distinct_files.h"
#include "engine/io/file.h"
#include "engine/scene/udim.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

namespace fs = std::filesystem;

constexpr char const* kNullDevice = "/dev/null";

bool IsWordCharacter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// How many of a text's first characters from `start` on can stand in a word.
size_t MeasureWord(std::string_view text, size_t start) {
    size_t end = start;
    while (end < text.size() && IsWordCharacter(text[end])) ++end;
    return end - start;
}

/// The length as far as the bracket that closes; 0 without one.
size_t MeasureBrackets(std::string_view text, char close) {
    return text.find(close) + 1;  // npos + 1 is 0
}

/// printf's and Python's "%04d", "%(UDIM)d", "%(name)s"; no token is "%d" of "50%done".
size_t MeasureConversion(std::string_view text) {
    bool const isNamed = text.starts_with("%(");
    size_t const start = isNamed ? MeasureBrackets(text, ')') : 1;
    size_t const letter = start == 0 ? text.npos : text.find_first_not_of("0123456789", start);
    if (letter == text.npos || (text[letter] != 'd' && text[letter] != 's')) return 0;
    return isNamed || MeasureWord(text, letter) == 1 ? letter + 1 : 0;
}

/// "[UDIM]", "[map]"; other words may stand in brackets, as in "spot [old].exr".
size_t MeasureSquareBrackets(std::string_view text) {
    size_t const length = MeasureBrackets(text, ']');
    if (length == 0) return 0;
    std::string word(text.substr(1, length - 2));
    for (char& c : word) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
    constexpr std::string_view kWords[] = {"map",    "mesh", "group", "udim",
                                           "uvtile", "tile", "frame"};
    return std::ranges::find(kWords, word) == std::end(kWords) ? 0 : length;
}

/// "$UDIM", "$F4", "${map}": variables that nobody has put in.
size_t MeasureVariable(std::string_view text) {
    if (text.starts_with("${")) return MeasureBrackets(text, '}');
    size_t const length = MeasureWord(text, 1);
    bool const isName = length > 0 && !(text[1] >= '0' && text[1] <= '9');
    return isName ? 1 + length : 0;
}

/// "####", "@@@": digits of a frame.
size_t MeasureRun(std::string_view text) {
    size_t const length = std::min(text.find_first_not_of(text[0]), text.size());
    return length > 1 ? length : 0;
}

/// The length of the token with which a text begins, limn's or another program's; 0 without one.
size_t MeasureToken(std::string_view text) {
    switch (text[0]) {
        case '{':
            return MeasureBrackets(text, '}');
        case '<':
            return MeasureBrackets(text, '>');
        case '[':
            return MeasureSquareBrackets(text);
        case '%':
            return MeasureConversion(text);
        case '$':
            return MeasureVariable(text);
        case '#':
        case '@':
            return MeasureRun(text);
        default:
            return 0;
    }
}

/// Calls visit(text, isToken) for a pattern's parts, in order.
template <class Visit>
void ForEachPart(std::string_view pattern, Visit visit) {
    size_t literal = 0;
    for (size_t at = 0; at < pattern.size();) {
        size_t const length = MeasureToken(pattern.substr(at));
        if (length == 0) {
            ++at;
            continue;
        }
        visit(pattern.substr(literal, at - literal), false);
        visit(pattern.substr(at, length), true);
        literal = at += length;
    }
    visit(pattern.substr(literal), false);
}

/// What a token stands for; none where there is no such token.
std::optional<std::string> ExpandToken(std::string_view token, OutputName const& name) {
    if (token == "{map}") return AsFileName(name.map);
    if (token == "{mesh}") return name.mesh;
    if (token == "{group}") return AsFileName(name.group);
    if (!name.tile && HasUdimToken(token)) return std::string(token);
    return ExpandUdimToken(token, name.tile.value_or(UdimTile{}.GetNumber()));
}

/// True if a file is one that an output's name may become, where this has a tile's token.
bool IsTileOf(std::string const& output, std::string const& file) {
    if (!HasUdimToken(output)) return false;
    constexpr int kLast = UdimTile{9, kMaxUdimRows - 1}.GetNumber();
    for (int tile = UdimTile{}.GetNumber(); tile <= kLast; ++tile) {
        if (ReplaceUdimToken(output, tile) == file) return true;
    }
    return false;
}

}  // namespace

std::string AsFileName(std::string name) {
    std::ranges::replace_if(name, [](char c) { return c == ':' || c == '/'; }, '_');
    return name;
}

std::string ExpandPattern(std::string const& pattern, OutputName const& name) {
    std::string path;
    ForEachPart(pattern, [&](std::string_view text, bool isToken) {
        auto const value = isToken ? ExpandToken(text, name) : std::nullopt;
        path += value ? *value : std::string(text);
    });
    return path;
}

std::string ExpandWithoutTile(std::string const& pattern, OutputName const& name) {
    constexpr std::string_view kParting = "._-";
    std::string stem;
    ForEachPart(pattern, [&](std::string_view text, bool isToken) {
        if (!isToken || !HasUdimToken(text)) {
            stem += ExpandPattern(std::string(text), name);
        } else if (!stem.empty() && kParting.find(stem.back()) != kParting.npos) {
            stem.pop_back();
        }
    });
    stem.resize(stem.size() - GetEnding(pattern).size());
    return stem.empty() || stem.ends_with('/') ? stem : stem + '.';
}

void CheckTokens(std::string const& pattern) {
    ForEachPart(pattern, [&](std::string_view text, bool isToken) {
        if (!isToken || ExpandToken(text, {.tile = UdimTile{}.GetNumber()})) return;
        throw Error(ErrorCode::BadOption,
                    fmt::format("`pattern` '{}': there is no token '{}'; there are: {{map}}, "
                                "{{mesh}}, {{group}}, {}",
                                pattern, text, ListUdimTokens()));
    });
}

void RequireExrEnding(std::string const& pattern) {
    if (GetEnding(pattern) == ".exr" || pattern == kNullDevice) return;
    throw Error(ErrorCode::BadOption,
                fmt::format("`pattern` '{}': maps are written as .exr", pattern));
}

void OutputNames::Add(BakeOptions const& options, std::string const& mesh,
                      std::string const& path) {
    std::vector<std::string> maps = options.maps;
    if (!HasMapToken(options.pattern)) maps = {fmt::format("{}", fmt::join(options.maps, "+"))};
    for (std::string const& map : maps) {
        std::string const file =
            ExpandPattern(options.pattern, {.map = map, .mesh = mesh, .group = options.group});
        if (file == kNullDevice) continue;
        RequireSeeking(file);
        std::string const of = options.group.empty()
                                   ? fmt::format("{} of '{}'", map, path)
                                   : fmt::format("{} of '{}', {}", map, path, options.group);
        auto const [found, isNew] = _owners.try_emplace(NormalisePath(file), of);
        if (isNew) {
            AddPreviews(options, file, of);
            continue;
        }
        throw Error(ErrorCode::BadOption,
                    fmt::format("`pattern`: two outputs are named '{}': {}, and {}", file,
                                found->second, of));
    }
}

void OutputNames::AddPreviews(BakeOptions const& options, std::string const& file,
                              std::string const& of) {
    if (!options.hasPreview) return;
    std::string const stem = fs::path(file).replace_extension().string();
    bool const hasLayers = options.maps.size() > 1 && !HasMapToken(options.pattern);
    for (std::string const& map : options.maps) {
        std::string const name = hasLayers ? stem + "." + AsFileName(map) : stem;
        _owners.try_emplace(NormalisePath(name + kPictureEnding), "preview, " + of);
        if (options.hasPreviewLegend)
            _owners.try_emplace(NormalisePath(name + kLegendEnding), "legend, " + of);
    }
}

void OutputNames::Refuse(std::string const& path, std::string const& what) const {
    std::string const file = NormalisePath(path);
    for (auto const& [output, of] : _owners) {
        if (output != file && !IsTileOf(output, file)) continue;
        throw Error(ErrorCode::BadOption,
                    fmt::format("'{}' is {}, and an output, too: {}", path, what, of));
    }
}

}  // namespace limn::engine
