// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/maps/map_table.h"

#include <gtest/gtest.h>

#include "far_ext/error.h"
#include "support/map_options.h"
#include "support/meshes.h"

namespace limn {
namespace {

using engine::MapTraits;
using engine::RangeKind;

std::vector<std::unique_ptr<engine::Map>> MakeAll(engine::BakeOptions const& options) {
    return engine::MakeMaps(options, test::MakeModelWithColours());
}

// Whoever averages, shows or writes a map relies on these.
TEST(MapTable, EveryMapDescribesAllItsChannels) {
    for (auto const& map : MakeAll(test::OptionsForAllMaps(test::MakeModelWithColours()))) {
        MapTraits const& traits = map->GetTraits();
        SCOPED_TRACE(traits.name);
        EXPECT_FALSE(traits.channels.empty());
        EXPECT_FALSE(traits.units.empty());
        int next = 0;
        for (engine::ChannelGroup const& group : traits.GetGroups()) {
            EXPECT_EQ(group.first, next);
            if (group.averaging == engine::Averaging::Line) {
                EXPECT_EQ(group.count, 3);
            }
            next += group.count;
        }
        EXPECT_EQ(next, traits.GetNumChannels());
        bool const isColour = traits.range == RangeKind::Vector ||
                              traits.range == RangeKind::UnitVector ||
                              traits.range == RangeKind::Line;
        if (isColour) {
            EXPECT_EQ(traits.GetNumChannels(), 3);
        }
    }
}

TEST(MapTable, ListsEveryMapThatOptionsForAllMapsName) {
    auto const options = test::OptionsForAllMaps(test::MakeModelWithColours());
    std::string listed = engine::ListMapNames() + ",";
    size_t numListed = 0;
    for (char c : listed) numListed += c == ',';
    EXPECT_EQ(options.maps.size(), numListed) << listed;
}

// The message goes to somebody who has mistyped a name: it lists what there is.
TEST(MapTable, AnUnknownNameIsAnsweredWithTheNamesThereAre) {
    engine::BakeOptions options;
    options.maps = {"curvture"};
    try {
        MakeAll(options);
        FAIL() << "no error";
    } catch (Error const& error) {
        EXPECT_EQ(error.GetCode(), ErrorCode::BadOption);
        EXPECT_NE(std::string(error.what()).find("curvture"), std::string::npos);
        EXPECT_NE(std::string(error.what()).find(engine::ListMapNames()), std::string::npos);
    }
}

TEST(MapTable, NothingAMapNeedsMayBeMissing) {
    for (char const* name : {"displacement", "tension", "field", "primvar:none"}) {
        engine::BakeOptions options;
        options.maps = {name};
        EXPECT_THROW(MakeAll(options), Error) << name;
    }
    engine::BakeOptions twice;
    twice.maps = {"mean", "mean"};
    EXPECT_THROW(MakeAll(twice), Error);
    EXPECT_THROW(MakeAll({}), Error);
}

TEST(MapTable, FlowIsForTheFieldAlone) {
    auto options = test::OptionsForAllMaps(test::MakeModelWithColours());
    options.space = engine::VectorSpace::UV;
    EXPECT_THROW(MakeAll(options), Error);
    options.maps = {"field"};
    EXPECT_EQ(MakeAll(options)[0]->GetTraits().range, RangeKind::Flow);
}

}  // namespace
}  // namespace limn
