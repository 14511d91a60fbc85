// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/maps/map_table.h"

#include <algorithm>

#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::engine {

namespace {

struct MapRow {
    char const* name;  ///< a map's, or the first part of one that ends with ':'
    MakeMap make;
};

constexpr MapRow kMaps[] = {{"mean", MakeCurvatureMap},
                            {"gaussian", MakeCurvatureMap},
                            {"k1", MakeCurvatureMap},
                            {"k2", MakeCurvatureMap},
                            {"curvedness", MakeCurvatureMap},
                            {"shape-index", MakeCurvatureMap},
                            {"curvature", MakeCurvatureMap},
                            {"principal-direction", MakeVectorMap},
                            {"position", MakeVectorMap},
                            {"normal", MakeVectorMap},
                            {"displacement", MakeDisplacementMap},
                            {"stretch", MakeStretchMap},
                            {"tension", MakeTensionMap},
                            {"bands", MakeBandsMap},
                            {"noise", MakeNoiseMap},
                            {"field", MakeFieldMap},
                            {"primvar:", MakePrimvarMap}};

bool IsPrefix(std::string_view name) {
    return name.ends_with(':');
}

}  // namespace

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
        auto const row = std::find_if(std::begin(kMaps), std::end(kMaps), [&](MapRow const& r) {
            return IsPrefix(r.name) ? name.starts_with(r.name) : name == r.name;
        });
        if (row == std::end(kMaps)) {
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
