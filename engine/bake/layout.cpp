// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/layout.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/bake/output_names.h"
#include "engine/images/exr_names.h"
#include "engine/scene/subdivision_names.h"
#include "engine/version.h"

namespace limn::engine {

std::vector<FileLayout> LayOutFiles(std::vector<std::unique_ptr<Map>> const& maps,
                                    std::string const& pattern, bool hasCoverage) {
    std::vector<FileLayout> files;
    int numPlanes = 0;
    for (auto const& map : maps) {
        MapTraits const& traits = map->GetTraits();
        if (files.empty() || HasMapToken(pattern)) {
            files.emplace_back();
            files.back().firstPlane = numPlanes;
        }
        FileLayout& file = files.back();
        for (ChannelGroup group : traits.GetGroups()) {
            group.first += file.numPlanes;
            file.groups.push_back(group);
        }
        file.maps.push_back(traits);
        file.numPlanes += traits.GetNumChannels();
        numPlanes += traits.GetNumChannels();
    }
    for (FileLayout& file : files) {
        for (MapTraits const& map : file.maps) {
            std::string const layer = file.maps.size() > 1 ? AsFileName(map.name) + "." : "";
            for (std::string const& channel : map.channels) {
                file.channelNames.push_back(layer + channel);
            }
            file.mapName += (file.mapName.empty() ? "" : "+") + map.name;
        }
        if (hasCoverage) file.channelNames.push_back("coverage");
    }
    return files;
}

std::optional<std::array<double, 3>> FileLayout::FindOrigin() const {
    for (MapTraits const& map : maps) {
        if (map.origin) return map.origin;
    }
    return {};
}

std::vector<char> FileLayout::FindHalfChannels(BakeOptions const& options) const {
    std::vector<char> isHalf;
    bool areAll = true;
    for (MapTraits const& map : maps) {
        isHalf.insert(isHalf.end(), map.channels.size(), options.IsHalf(map.name));
        areAll &= options.IsHalf(map.name);
    }
    isHalf.resize(channelNames.size(), areAll);
    return isHalf;
}

namespace {

/// "float", "half", or "half:MAP,MAP" where these are and the others are not.
std::string DescribeTypes(BakeOptions const& options, FileLayout const& file) {
    std::vector<std::string> halves;
    for (MapTraits const& map : file.maps) {
        if (options.IsHalf(map.name)) halves.push_back(map.name);
    }
    if (halves.empty()) return "float";
    if (halves.size() == file.maps.size()) return "half";
    return fmt::format("half:{}", fmt::join(halves, ","));
}

}  // namespace

std::string MakeOptionText(BakeOptions const& options, FileLayout const& file, Model const& model) {
    std::string text = fmt::format(
        "size={}x{} samples={} padding={} type={} compression={} mip={} coverage={}", options.width,
        options.height, options.samplesPerSide, options.padding, DescribeTypes(options, file),
        kExrCompressionWords.GetWord(options.compression), options.hasMips, options.hasCoverage);
    text += fmt::format(" {} orientation={}", DescribeSubdivision(model.GetCage()),
                        kOrientationWords.GetWord(options.orientation));
    if (model.GetWeld()) text += fmt::format(" weld={}", model.GetWeld()->tolerance);
    if (!options.groups.empty()) {
        std::set<std::string> const groups(options.groups.begin(), options.groups.end());
        text += fmt::format(" groups={}", fmt::join(groups, ","));
    }
    if (options.encoding) {
        text += fmt::format(" encode={},{}", options.encoding->scale, options.encoding->offset);
    }
    for (MapTraits const& map : file.maps) {
        if (!map.optionText.empty()) text += " " + map.optionText;
    }
    if (std::any_of(file.maps.begin(), file.maps.end(),
                    [](MapTraits const& map) { return map.hasVectorOptions; })) {
        text += fmt::format(" vector={} space={}", options.isVector,
                            options.space == VectorSpace::Tangent ? "tangent" : "object");
    }
    return text;
}

Attributes MakeAttributes(BakeOptions const& options, FileLayout const& file, Model const& model,
                          int tile) {
    std::string units;
    for (MapTraits const& map : file.maps) {
        units +=
            (units.empty() ? "" : "; ") + (file.maps.size() > 1 ? map.name + " " : "") + map.units;
    }
    Attributes attributes{
        {"limn:convention",
         "sphere of radius r, seen from outside: k1 = k2 = +1/r; object space; v up"},
        {"limn:input", model.GetSha256()},
        {"limn:map", file.mapName},
        {"limn:options", MakeOptionText(options, file, model)},
        {"limn:tile", std::to_string(tile)},
        {"limn:units", units},
        {"limn:version", kVersion}};
    for (MapTraits const& map : file.maps) {
        if (map.against) attributes.emplace_back("limn:against", *map.against);
    }
    if (options.encoding) {
        attributes.emplace_back("limn:scale", fmt::format("{}", options.encoding->scale));
        attributes.emplace_back("limn:offset", fmt::format("{}", options.encoding->offset));
    }
    for (MapTraits const& map : file.maps) {
        std::string const origin = map.GetOriginText();
        if (!origin.empty()) attributes.emplace_back("limn:origin", origin);
    }
    if (options.hasMips) {  // what texture systems look for before they trust a file's levels
        attributes.emplace_back("textureformat", "Plain Texture");
        attributes.emplace_back("wrapmodes", "black,black");
    }
    return attributes;
}

std::optional<ValueRange> FindUpToDate(std::string const& path, Attributes const& attributes,
                                       std::function<void()> const& check) {
    if (FindOutputKind(path) != OutputKind::File) return {};
    auto existing = ReadExrAttributes(path, "limn:");
    std::erase_if(existing,
                  [](auto const& attribute) { return attribute.first == kSealAttribute; });
    Attributes wanted;
    for (auto const& attribute : attributes) {
        if (attribute.first.starts_with("limn:")) wanted.push_back(attribute);
    }
    std::sort(existing.begin(), existing.end());
    std::sort(wanted.begin(), wanted.end());
    if (existing != wanted) return {};
    return CheckSeal(path, check);
}

}  // namespace limn::engine
