// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/options/nearest_words.h"

#include <gtest/gtest.h>

namespace limn::cli {
namespace {

using Words = std::vector<std::string>;

Words const kVerbs{"info", "eval", "bake", "refine", "measure", "fit", "bands", "smooth"};
Words const kFlags{"-o",        "--output",        "--size",          "--samples",
                   "--preview", "--preview-range", "--noise-octaves", "--noise-seed"};

TEST(NearestWords, AreOneEditAway) {
    EXPECT_EQ(FindNearestWords("bakee", kVerbs), Words{"bake"});  // a letter more
    EXPECT_EQ(FindNearestWords("bke", kVerbs), Words{"bake"});    // a letter less
    EXPECT_EQ(FindNearestWords("bale", kVerbs), Words{"bake"});   // another letter
    EXPECT_EQ(FindNearestWords("bkae", kVerbs), Words{"bake"});   // two swapped
    EXPECT_EQ(FindNearestWords("--sise", kFlags), Words{"--size"});
}

TEST(NearestWords, AreTheOnesThatBeginSo) {
    EXPECT_EQ(FindNearestWords("meas", kVerbs), Words{"measure"});
    EXPECT_EQ(FindNearestWords("--out", kFlags), Words{"--output"});
    EXPECT_EQ(FindNearestWords("--noise", kFlags), (Words{"--noise-octaves", "--noise-seed"}));
}

TEST(NearestWords, DoNotMindCapitalsAndDashes) {
    EXPECT_EQ(FindNearestWords("Bake", kVerbs), Words{"bake"});
    EXPECT_EQ(FindNearestWords("-size", kFlags), Words{"--size"});
    EXPECT_EQ(FindNearestWords("--noise_seed", kFlags), Words{"--noise-seed"});
}

TEST(NearestWords, AreSeveralOnlyWhereEquallyNear) {
    EXPECT_EQ(FindNearestWords("bane", {"bake", "band", "bind"}), (Words{"bake", "band"}));
    EXPECT_EQ(FindNearestWords("band", {"bands", "bond", "band"}), Words{"band"});
}

TEST(NearestWords, AreNoneWhereNothingIsNear) {
    for (char const* word : {"", "-", "frobnicate", "x", "xyz", "unwrap"})
        EXPECT_TRUE(FindNearestWords(word, kVerbs).empty()) << word;
    EXPECT_EQ(AskForNearest("frobnicate", kVerbs), "");
    EXPECT_EQ(AskForNearest("bkae", kVerbs), "; did you mean bake?");
}

}  // namespace
}  // namespace limn::cli
