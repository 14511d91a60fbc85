// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/udim.h"

#include <limits>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace limn {
namespace {

using engine::FindUdimTile;
using engine::ToUdimTile;

TEST(Udim, NumbersAndTilesAreTheSameThing) {
    EXPECT_EQ(ToUdimTile(1001).u, 0);
    EXPECT_EQ(ToUdimTile(1010).u, 9);
    EXPECT_EQ(ToUdimTile(1011).v, 1);
    for (int number = 1001; number <= 9999; ++number) {
        EXPECT_EQ(ToUdimTile(number).GetNumber(), number);
    }
}

TEST(Udim, APlaceLiesInTheTileThatHoldsIt) {
    EXPECT_EQ(FindUdimTile(0.0, 0.0)->GetNumber(), 1001);
    EXPECT_EQ(FindUdimTile(2.5, 1.25)->GetNumber(), 1013);
    EXPECT_EQ(FindUdimTile(9.999, 0.5)->GetNumber(), 1010);
}

TEST(Udim, PlacesBeyondTheRangeHaveNone) {
    double const nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(FindUdimTile(-1e-9, 0.5));
    EXPECT_FALSE(FindUdimTile(10.0, 0.5));
    EXPECT_FALSE(FindUdimTile(0.5, -0.1));
    EXPECT_FALSE(FindUdimTile(0.5, 1e30));
    EXPECT_FALSE(FindUdimTile(nan, 0.5));
}

TEST(Udim, AListOfTilesIsALineAtMost) {
    EXPECT_EQ(engine::ListTiles({1001, 1012}), "1001, 1012");
    std::vector<int> tiles(23);
    std::iota(tiles.begin(), tiles.end(), 1001);
    EXPECT_TRUE(engine::ListTiles(tiles).ends_with(", 1020 and 3 more"));
}

TEST(Udim, EveryTokenIsReplacedWhereverItStands) {
    EXPECT_TRUE(engine::HasUdimToken("a.<UDIM>.exr"));
    EXPECT_TRUE(engine::HasUdimToken("{udim}/a.exr"));
    EXPECT_FALSE(engine::HasUdimToken("a.udim.exr"));
    EXPECT_EQ(engine::ReplaceUdimToken("{udim}/a.<UDIM>.exr", 1012), "1012/a.1012.exr");
    EXPECT_EQ(engine::ReplaceUdimToken("%(UDIM)d.<udim>", 1001), "1001.1001");
}

// Mudbox calls the first tile u1_v1, Mari u0_v0.
TEST(Udim, TilesByColumnAndRowCountAsTheirProgramsDo) {
    EXPECT_EQ(engine::ExpandUdimToken("<UVTILE>", 1001), "u1_v1");
    EXPECT_EQ(engine::ExpandUdimToken("<uvtile>", 1001), "u0_v0");
    EXPECT_EQ(engine::ExpandUdimToken("<UVTILE>", 1023), "u3_v3");
    EXPECT_EQ(engine::ExpandUdimToken("<uvtile>", 1110), "u9_v10");
    EXPECT_FALSE(engine::ExpandUdimToken("<UVtile>", 1001));
}

}  // namespace
}  // namespace limn
