// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/maps/map_table.h"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::engine {

namespace {

struct MapRow {
    std::string_view name;  ///< a map's, or the first part of one that ends with ':'
    MakeMap make;
    std::string_view members;  ///< of MapOptions: those that it takes, beside the encoding
};

constexpr MapRow kMaps[] = {{"mean", MakeCurvatureMap, ""},
                            {"gaussian", MakeCurvatureMap, ""},
                            {"k1", MakeCurvatureMap, ""},
                            {"k2", MakeCurvatureMap, ""},
                            {"curvedness", MakeCurvatureMap, ""},
                            {"shape-index", MakeCurvatureMap, ""},
                            {"curvature", MakeCurvatureMap, ""},
                            {"principal-direction", MakeVectorMap, ""},
                            {"position", MakePositionMap, "origin"},
                            {"normal", MakeVectorMap, ""},
                            {"displacement", MakeDisplacementMap, "against isVector space"},
                            {"stretch", MakeStretchMap, ""},
                            {"tension", MakeTensionMap, "rest"},
                            {"bands", MakeBandsMap, "bands bandSum isVector space evaluator"},
                            {"noise", MakeNoiseMap, "noise noiseRamp isNormalized evaluator"},
                            {"field", MakeFieldMap, "field space isNormalized evaluator"},
                            {"overlap", MakeOverlapMap, ""},
                            {"primvar:", MakePrimvarMap, ""}};

bool IsPrefix(std::string_view name) {
    return name.ends_with(':');
}

MapRow const* FindRow(std::string_view name) {
    auto const row = std::ranges::find_if(kMaps, [&](MapRow const& r) {
        return IsPrefix(r.name) ? name.starts_with(r.name) : name == r.name;
    });
    return row == std::end(kMaps) ? nullptr : row;
}

}  // namespace

bool IsMapName(std::string_view name) {
    return FindRow(name) != nullptr;
}

std::vector<std::string> ListFixedMapNames() {
    std::vector<std::string> names;
    for (MapRow const& row : kMaps) {
        if (!IsPrefix(row.name)) names.emplace_back(row.name);
    }
    return names;
}

std::vector<std::string> ListMapsThatTake(std::string_view member) {
    std::vector<std::string> names;
    for (MapRow const& row : kMaps) {
        std::istringstream words{std::string(row.members)};
        if (std::find(std::istream_iterator<std::string>(words), {}, member) !=
            std::istream_iterator<std::string>())
            names.emplace_back(row.name);
    }
    return names;
}

std::string ListMapNames() {
    std::string names;
    for (MapRow const& row : kMaps) {
        names += (names.empty() ? "" : ", ") + std::string(row.name);
        if (IsPrefix(row.name)) names += "NAME";
    }
    return names;
}

std::vector<std::unique_ptr<Map>> MakeMaps(MapOptions const& options, Model const& model) {
    std::vector<std::unique_ptr<Map>> maps;
    for (std::string const& name : options.maps) {
        if (std::any_of(maps.begin(), maps.end(),
                        [&](auto const& map) { return map->GetTraits().name == name; })) {
            throw Error(ErrorCode::BadOption, fmt::format("`maps`: '{}' is asked for twice", name));
        }
        MapRow const* const row = FindRow(name);
        if (!row) {
            throw Error(
                ErrorCode::BadOption,
                fmt::format("`maps`: there is no map '{}'; there are: {}", name, ListMapNames()));
        }
        maps.push_back(row->make(name, options, model));
        if (options.space == VectorSpace::UV && maps.back()->GetTraits().range != RangeKind::Flow) {
            throw Error(ErrorCode::BadOption,
                        fmt::format("`space` uv is for the map field alone, not for '{}'", name));
        }
    }
    if (maps.empty()) {
        throw Error(ErrorCode::BadOption, fmt::format("`maps`: choose from {}", ListMapNames()));
    }
    return maps;
}

}  // namespace limn::engine
