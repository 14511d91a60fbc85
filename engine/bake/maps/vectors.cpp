// SPDX-License-Identifier: Apache-2.0
//
// Normal and principal direction of the limit surface, in object space.

#include "engine/bake/maps/map_table.h"

namespace limn::engine {

std::unique_ptr<Map> MakeVectorMap(std::string const& name, MapOptions const&, Model const&) {
    MapTraits traits{.name = name, .channels = {"R", "G", "B"}, .units = "unit vector"};
    if (name == "normal") {
        traits.range = RangeKind::UnitVector;
        traits.groups = {{0, 3, Averaging::UnitVector}};
        traits.quantity = eval::Quantity::Normal;
        return MakePointwiseMap(std::move(traits), CopyVector<eval::kNormalX>);
    }
    traits.range = RangeKind::Line;
    traits.groups = {{0, 3, Averaging::Line}};
    traits.quantity = eval::Quantity::Direction;
    return MakePointwiseMap(std::move(traits), CopyVector<eval::kDirectionX>);
}

}  // namespace limn::engine
