// SPDX-License-Identifier: Apache-2.0
#include "far_ext/enum_words.h"

#include <gtest/gtest.h>

#include "support/errors.h"

namespace limn {
namespace {

enum class Side { Left, Right, Neither };

constexpr auto kSides = MakeEnumWords<Side>("side", {{Side::Right, "right"}, {Side::Left, "left"}});

TEST(EnumWords, AValueHasItsWord) {
    EXPECT_STREQ(kSides.GetWord(Side::Left), "left");
    EXPECT_STREQ(kSides.GetWord(Side::Right), "right");
    EXPECT_STREQ(kSides.GetWord(Side::Neither), "unknown");
}

TEST(EnumWords, AWordHasItsValue) {
    EXPECT_EQ(kSides.Parse("left"), Side::Left);
    EXPECT_EQ(kSides.Find("right"), Side::Right);
    EXPECT_FALSE(kSides.Find("Right"));
}

TEST(EnumWords, AnUnknownWordIsRefusedWithThoseThereAre) {
    EXPECT_EQ(test::RefusalOf([] { kSides.Parse("up"); }),
              "`side`: 'up' is not one of right, left");
}

}  // namespace
}  // namespace limn
