// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/layout.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/scene/subdivision_names.h"

namespace limn::engine {

namespace {

void ReplaceAll(std::string& text, std::string const& token, std::string const& value) {
    for (size_t at = text.find(token); at != std::string::npos;
         at = text.find(token, at + value.size())) {
        text.replace(at, token.size(), value);
    }
}

/// A map's name where it becomes part of a path or of a channel's name.
std::string AsFileName(std::string name) {
    std::replace_if(name.begin(), name.end(), [](char c) { return c == ':' || c == '/'; }, '_');
    return name;
}

}  // namespace

bool HasUdimToken(std::string const& pattern) {
    return pattern.find("<UDIM>") != std::string::npos ||
           pattern.find("{udim}") != std::string::npos;
}

std::string ExpandPattern(std::string const& pattern, std::string const& map,
                          std::string const& mesh, int tile) {
    std::string path = pattern;
    ReplaceAll(path, "{map}", AsFileName(map));
    ReplaceAll(path, "{mesh}", mesh);
    ReplaceAll(path, "<UDIM>", std::to_string(tile));
    ReplaceAll(path, "{udim}", std::to_string(tile));
    return path;
}

std::vector<FileLayout> LayOutFiles(std::vector<Map> const& maps, std::string const& pattern,
                                    bool hasCoverage) {
    bool const hasMapToken = pattern.find("{map}") != std::string::npos;
    std::vector<FileLayout> files;
    int numPlanes = 0;
    for (Map const& map : maps) {
        if (files.empty() || hasMapToken) {
            files.emplace_back();
            files.back().firstPlane = numPlanes;
        }
        FileLayout& file = files.back();
        file.maps.push_back(map);
        file.groups.push_back({file.numPlanes, map.GetNumChannels(), map.averaging});
        file.numPlanes += map.GetNumChannels();
        numPlanes += map.GetNumChannels();
    }
    for (FileLayout& file : files) {
        for (Map const& map : file.maps) {
            std::string const layer = file.maps.size() > 1 ? AsFileName(map.name) + "." : "";
            for (std::string const& channel : map.channels)
                file.channelNames.push_back(layer + channel);
            file.mapName += (file.mapName.empty() ? "" : "+") + map.name;
        }
        if (hasCoverage) file.channelNames.push_back("coverage");
    }
    return files;
}

std::string MakeOptionText(BakeOptions const& options, FileLayout const& file, Scene const& scene) {
    std::string text = fmt::format(
        "size={}x{} samples={} padding={} type={} compression={} mip={} coverage={}", options.width,
        options.height, options.samplesPerSide, options.padding, options.isHalf ? "half" : "float",
        GetName(options.compression), options.hasMips, options.hasCoverage);
    text += fmt::format(" {} orientation={}", DescribeSubdivision(scene.cage),
                        options.isLeftHanded ? "left" : "right");
    if (!options.groups.empty()) {
        std::set<std::string> const groups(options.groups.begin(), options.groups.end());
        text += fmt::format(" groups={}", fmt::join(groups, ","));
    }
    if (options.maps.hasEncoding) {
        text += fmt::format(" encode={},{}", options.maps.encodeScale, options.maps.encodeOffset);
    }
    auto const has = [&](MapKind kind) {
        return std::any_of(file.maps.begin(), file.maps.end(),
                           [&](Map const& map) { return map.kind == kind; });
    };
    if (has(MapKind::Bands)) text += fmt::format(" bands={}", options.maps.numBands);
    if (has(MapKind::Noise)) {
        text += fmt::format(" octaves={} frequency={} gain={} seed={} normalize={} ramp={}",
                            options.noise.octaves, options.noise.frequency, options.noise.gain,
                            options.noise.seed, options.maps.isNormalized,
                            options.maps.ramp ? options.maps.ramp->GetText() : "none");
    }
    if (has(MapKind::Field)) {
        text += fmt::format(" field={} flow={} normalize={}", options.fieldHash,
                            options.maps.space == MapSpace::UV ? "uv" : "object",
                            options.maps.isNormalized);
    }
    if (has(MapKind::Displacement) || has(MapKind::Bands)) {
        text += fmt::format(" vector={} space={}", options.maps.isVector,
                            options.maps.space == MapSpace::Tangent ? "tangent" : "object");
    }
    return text;
}

std::vector<std::pair<std::string, std::string>> MakeAttributes(BakeOptions const& options,
                                                                FileLayout const& file,
                                                                Scene const& scene,
                                                                Scene const* other) {
    std::string units;
    for (Map const& map : file.maps) {
        units +=
            (units.empty() ? "" : "; ") + (file.maps.size() > 1 ? map.name + " " : "") + map.units;
    }
    std::vector<std::pair<std::string, std::string>> attributes{
        {"limn:convention",
         "sphere of radius r, seen from outside: k1 = k2 = +1/r; object space; v up"},
        {"limn:input", scene.sha256},
        {"limn:map", file.mapName},
        {"limn:options", MakeOptionText(options, file, scene)},
        {"limn:units", units},
        {"limn:version", options.version}};
    if (other) attributes.emplace_back("limn:against", other->sha256);
    if (options.maps.hasEncoding) {
        attributes.emplace_back("limn:scale", fmt::format("{}", options.maps.encodeScale));
        attributes.emplace_back("limn:offset", fmt::format("{}", options.maps.encodeOffset));
    }
    if (options.hasMips) {  // what texture systems look for before they trust a file's levels
        attributes.emplace_back("textureformat", "Plain Texture");
        attributes.emplace_back("wrapmodes", "black,black");
    }
    return attributes;
}

bool IsUpToDate(std::string const& path,
                std::vector<std::pair<std::string, std::string>> const& attributes) {
    auto existing = ReadExrAttributes(path, "limn:");
    std::vector<std::pair<std::string, std::string>> wanted;
    for (auto const& attribute : attributes) {
        if (attribute.first.starts_with("limn:")) wanted.push_back(attribute);
    }
    std::sort(existing.begin(), existing.end());
    std::sort(wanted.begin(), wanted.end());
    return existing == wanted;
}

}  // namespace limn::engine
