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

/// Calls visit(text, isToken) for a pattern's parts, in order.
template <class Visit>
void ForEachPart(std::string_view pattern, Visit visit) {
    struct Brackets {
        std::string_view open, close;
    };
    constexpr Brackets kBrackets[] = {{"{", "}"}, {"<", ">"}, {"%(", ")d"}};
    size_t literal = 0;
    for (size_t at = 0; at < pattern.size();) {
        auto const brackets = std::ranges::find_if(
            kBrackets, [&](Brackets const& b) { return pattern.substr(at).starts_with(b.open); });
        size_t const close = brackets == std::end(kBrackets)
                                 ? std::string_view::npos
                                 : pattern.find(brackets->close, at + brackets->open.size());
        if (close == std::string_view::npos) {
            ++at;
            continue;
        }
        size_t const end = close + brackets->close.size();
        visit(pattern.substr(literal, at - literal), false);
        visit(pattern.substr(at, end - at), true);
        literal = at = end;
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
