// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/output_names.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/files.h"

namespace limn {
namespace {

using engine::BakeOptions;
using engine::ExpandPattern;
using engine::OutputNames;

TEST(ExpandPattern, ReplacesEveryToken) {
    EXPECT_EQ(
        ExpandPattern("out/{mesh}/{map}.<UDIM>.exr", {.map = "mean", .mesh = "spot", .tile = 1012}),
        "out/spot/mean.1012.exr");
    EXPECT_EQ(ExpandPattern("{map}{map}.{group}.exr", {.map = "k1", .group = "skin"}),
              "k1k1.skin.exr");
    EXPECT_EQ(ExpandPattern("a.exr", {.map = "mean", .mesh = "spot", .tile = 1001}), "a.exr");
}

TEST(ExpandPattern, TakesTheSpellingsOfOtherPrograms) {
    for (auto const& [token, value] : {std::pair{"<UDIM>", "1012"},
                                       {"{udim}", "1012"},
                                       {"<udim>", "1012"},
                                       {"%(UDIM)d", "1012"},
                                       {"<UVTILE>", "u2_v2"},
                                       {"<uvtile>", "u1_v1"}}) {
        std::string const pattern = std::string("a.") + token + ".exr";
        engine::CheckTokens(pattern);
        EXPECT_EQ(ExpandPattern(pattern, {.tile = 1012}), std::string("a.") + value + ".exr");
        EXPECT_EQ(ExpandPattern(pattern, {}), pattern) << "without a tile the token stays";
    }
}

TEST(ExpandWithoutTile, LeavesTheTileAndItsSeparatorOut) {
    engine::OutputName const name{.map = "mean", .mesh = "spot"};
    for (auto const& [pattern, stem] : {std::pair{"out/{mesh}.{map}.<UDIM>.exr", "out/spot.mean."},
                                        {"{map}_%(UDIM)d.exr", "mean."},
                                        {"<UVTILE>/{map}.EXR", "/mean."},
                                        {"out/<UDIM>.exr", "out/"},
                                        {"a.exr", "a."}}) {
        EXPECT_EQ(engine::ExpandWithoutTile(pattern, name), stem) << pattern;
    }
}

// A mesh may be called as it likes: what is put in is not looked at again.
TEST(ExpandPattern, ReplacesNothingInWhatItHasPutIn) {
    EXPECT_EQ(ExpandPattern("{mesh}.{map}.<UDIM>.exr",
                            {.map = "primvar:<UDIM>", .mesh = "{map}", .tile = 1001}),
              "{map}.primvar_<UDIM>.1001.exr");
}

TEST(ExpandPattern, AMapsAndAGroupsNameIsOnePartOfAPath) {
    EXPECT_EQ(ExpandPattern("{map}.exr", {.map = "primvar:a/b"}), "primvar_a_b.exr");
    EXPECT_EQ(ExpandPattern("{group}.exr", {.group = "rig:a/b"}), "rig_a_b.exr");
}

TEST(CheckTokens, RefusesTokensThereAreNotAndListsThoseThereAre) {
    for (char const* token :
         {"{tile}",     "{MAP}", "{UDIM}", "<f>",    "<Udim>", "%(udim)d", "{}",      "{map }",
          "####",       "##",    "@@@",    "%04d",   "%d",     "%s",       "%(map)s", "%(MAP)s",
          "%(UDIM)04d", "$UDIM", "$F4",    "${map}", "[UDIM]", "[map]"}) {
        try {
            engine::CheckTokens(std::string("a.") + token + ".exr");
            ADD_FAILURE() << token;
        } catch (Error const& error) {
            std::string const message = error.what();
            EXPECT_EQ(error.GetCode(), ErrorCode::BadOption);
            EXPECT_NE(message.find(std::string("'") + token + "'"), std::string::npos) << message;
            EXPECT_NE(message.find("{map}, {mesh}, {group}, <UDIM>"), std::string::npos) << message;
        }
    }
}

TEST(CheckTokens, LeavesNamesAloneThatOnlyLookLikeTokens) {
    for (char const* pattern :
         {"a{b.exr",   "a}b.exr",    "a>b<c.exr",   "50%.exr",     "%(a.exr",
          "a.exr",     "take#2.exr", "me@home.exr", "50%done.exr", "50%sure.exr",
          "5%0d1.exr", "%(a)b.exr",  "[old].exr",   "[udim.exr",   "C$/a.exr",
          "$5.exr",    "a$",         "a%",          "%(",          "%(a)",
          "#"})
        EXPECT_NO_THROW(engine::CheckTokens(pattern)) << pattern;
}

TEST(RequireExrEnding, TakesExrAndTheNullDeviceOnly) {
    for (char const* pattern : {"a.exr", "A.EXR", "a.<UDIM>.exr", "/dev/null"})
        EXPECT_NO_THROW(engine::RequireExrEnding(pattern)) << pattern;
    for (char const* pattern :
         {"", "a", "a.", "a.tif", "a.exr.<UDIM>", "out/{map}", ".exr", "a.exr/b"}) {
        EXPECT_EQ(test::CodeOf([&] { engine::RequireExrEnding(pattern); }), ErrorCode::BadOption)
            << pattern;
    }
}

BakeOptions Named(std::string pattern, std::vector<std::string> maps = {"mean"}) {
    BakeOptions options;
    options.pattern = std::move(pattern);
    options.maps = std::move(maps);
    return options;
}

bool IsRefused(OutputNames& names, BakeOptions const& options, std::string const& mesh) {
    try {
        names.Add(options, mesh, mesh + ".obj");
        return false;
    } catch (Error const& error) {
        EXPECT_EQ(error.GetCode(), ErrorCode::BadOption);
        return true;
    }
}

TEST(OutputNames, RefusesTwoOutputsOfOneName) {
    OutputNames names;
    EXPECT_FALSE(IsRefused(names, Named("out/{mesh}.{map}.exr", {"mean", "k1"}), "spot"));
    EXPECT_FALSE(IsRefused(names, Named("out/{mesh}.{map}.exr", {"mean", "k1"}), "bob"));
    EXPECT_TRUE(IsRefused(names, Named("out/../out/{mesh}.{map}.exr"), "spot"));
    EXPECT_TRUE(IsRefused(names, Named("{map}.exr", {"primvar:a_b", "primvar:a/b"}), "spot"));
}

TEST(OutputNames, TellsGroupsApart) {
    OutputNames names;
    for (char const* group : {"red", "blue"}) {
        BakeOptions options = Named("{group}.exr");
        options.group = group;
        EXPECT_FALSE(IsRefused(names, options, "spot")) << group;
        EXPECT_TRUE(IsRefused(names, options, "spot")) << group;
    }
}

TEST(OutputNames, TheNullDeviceTakesAll) {
    OutputNames names;
    EXPECT_FALSE(IsRefused(names, Named("/dev/null"), "spot"));
    EXPECT_FALSE(IsRefused(names, Named("/dev/null"), "bob"));
}

TEST(OutputNames, RefusesAFileThatIsAnOutput) {
    test::TemporaryFolder const folder;
    OutputNames names;
    names.Add(Named(folder / "a.exr"), "spot", "spot.obj");
    names.Add(Named(folder / "{map}.<UDIM>.exr"), "spot", "spot.obj");
    std::filesystem::create_symlink(folder.GetPath(), folder / "link");
    auto const code = [&](std::string const& path) {
        return test::CodeOf([&] { names.Refuse(path, "the report"); });
    };
    for (char const* path : {"a.exr", "./a.exr", "link/a.exr", "mean.1001.exr", "mean.9999.exr"})
        EXPECT_EQ(code(folder / path), ErrorCode::BadOption) << path;
    for (char const* path : {"b.exr", "k1.1001.exr", "mean.exr", "mean.101.exr"})
        EXPECT_NO_THROW(names.Refuse(folder / path, "the report")) << path;
}

}  // namespace
}  // namespace limn
