// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/bake/maps/map.h"

namespace limn::engine {

/// Makes a map of this name, from what a bake is asked for.
///
/// \throws Error  BadOption where something the map needs is missing, or contradicts it
using MakeMap = std::unique_ptr<Map> (*)(std::string const& name, MapOptions const& options,
                                         Model const& model);

/// The maps that options.maps names, in that order.
///
/// \throws Error  BadOption: an unknown name (listing the maps there are), one twice, none; as
/// MakeMap
std::vector<std::unique_ptr<Map>> MakeMaps(MapOptions const& options, Model const& model);

bool IsMapName(std::string_view name);

/// The names of all maps but those that begin with a prefix.
std::vector<std::string> ListFixedMapNames();

/// The maps that a member of MapOptions has an effect on.
std::vector<std::string> ListMapsThatTake(std::string_view member);

/// "mean, gaussian, ..., primvar:NAME"
std::string ListMapNames();

// One maker per file of this folder.
std::unique_ptr<Map> MakeCurvatureMap(std::string const&, MapOptions const&, Model const&);
std::unique_ptr<Map> MakeVectorMap(std::string const&, MapOptions const&, Model const&);
std::unique_ptr<Map> MakePositionMap(std::string const&, MapOptions const&, Model const&);
std::unique_ptr<Map> MakeDisplacementMap(std::string const&, MapOptions const&, Model const&);
std::unique_ptr<Map> MakeStretchMap(std::string const&, MapOptions const&, Model const&);
std::unique_ptr<Map> MakeBandsMap(std::string const&, MapOptions const&, Model const&);
std::unique_ptr<Map> MakeNoiseMap(std::string const&, MapOptions const&, Model const&);
std::unique_ptr<Map> MakeFieldMap(std::string const&, MapOptions const&, Model const&);
std::unique_ptr<Map> MakeTensionMap(std::string const&, MapOptions const&, Model const&);
std::unique_ptr<Map> MakeOverlapMap(std::string const&, MapOptions const&, Model const&);
std::unique_ptr<Map> MakePrimvarMap(std::string const&, MapOptions const&, Model const&);

}  // namespace limn::engine
