// SPDX-License-Identifier: Apache-2.0
//
// Where a bake would have to choose: it says so, or refuses.

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "engine/images/exr_lookup.h"
#include "support/program/cli.h"

namespace limn {
namespace {

namespace fs = std::filesystem;
using namespace test::cli;

/// A cube of which every two sides share a third of the tile; `materials` are those of its sides.
std::string MakeCube(Words const& materials) {
    std::string text =
        "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n";
    for (int third = 0; third < 3; ++third) {
        for (auto const& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
            text += "vt " + std::to_string((third + u) / 3.0) + " " + std::to_string(v) + "\n";
    }
    char const* const sides[] = {"1/1 4/2 3/3 2/4", "5/5 6/6 7/7 8/8", "1/9 2/10 6/11 5/12",
                                 "2/1 3/2 7/3 6/4", "3/5 4/6 8/7 7/8", "4/9 1/10 5/11 8/12"};
    for (size_t side = 0; side < 6; ++side)
        text += "usemtl " + materials[side] + "\nf " + sides[side] + "\n";
    return text;
}

Words const kTwoMaterials{"red", "red", "red", "blue", "blue", "blue"};

class Choices : public Cli {
protected:
    /// A bake that says what it has to say.
    Outcome BakeAloud(std::string const& mesh, std::string const& output, Words const& more = {}) {
        bool const hasSize = std::ranges::find(more, "--size") != more.end();
        return Limn(Words{"bake", mesh, "-o", folder / output, "--maps", "mean", "--report",
                          folder / "r.json"} +
                    (hasSize ? Words{} : Words{"--size", "48"}) + more);
    }
    /// Of the one warning there is; empty if there is none.
    std::string Warning() const {
        json const warnings = Report()["warnings"];
        EXPECT_LE(warnings.size(), 1u) << warnings;
        return warnings.empty() ? "" : warnings[0].get<std::string>();
    }
};

// -------- overlaps and groups

TEST_F(Choices, TwoMaterialsOverOneTileAreSaidWithTheWayOut) {
    std::string const mesh = folder.Write("cube.obj", MakeCube(kTwoMaterials));
    ASSERT_EQ(BakeAloud(mesh, "a.exr").status, 0);
    EXPECT_TRUE(Contains(Warning(), "2304 of 2304 covered texels (100 %)")) << Warning();
    EXPECT_TRUE(Contains(Warning(), "first face 0 (line 22) and face 3 (line 28)")) << Warning();
    EXPECT_TRUE(Contains(Warning(), "red and blue")) << Warning();
    EXPECT_TRUE(Contains(Warning(), "--groups or with {group}")) << Warning();
    EXPECT_TRUE(Contains(Warning(), "--maps overlap")) << Warning();
    EXPECT_EQ(Report()["overlaps"], 2304);
}

TEST_F(Choices, AGroupTokenBakesGroupByGroup) {
    std::string const mesh = folder.Write("cube.obj", MakeCube(kTwoMaterials));
    ASSERT_EQ(BakeAloud(mesh, "{map}.{group}.exr").status, 0);
    EXPECT_EQ(Warning(), "");
    EXPECT_EQ(folder.List(), (Words{"cube.obj", "mean.blue.exr", "mean.red.exr", "r.json"}));
    for (char const* group : {"red", "blue"}) {
        ASSERT_EQ(Bake(mesh, "alone.exr", {"--groups", group, "--size", "48"}).status, 0);
        EXPECT_TRUE(test::ReadText(folder / "alone.exr") ==
                    test::ReadText(folder / ("mean." + std::string(group) + ".exr")));
    }
    ASSERT_EQ(Bake(mesh, "only.{group}.exr", {"--groups", "blue"}).status, 0);
    EXPECT_TRUE(fs::exists(folder / "only.blue.exr"));
    EXPECT_FALSE(fs::exists(folder / "only.red.exr"));
}

TEST_F(Choices, AGroupTokenNeedsGroups) {
    ExpectError(Bake(Shape("catmark_cube"), "a.{group}.exr"), 2, "has none");
}

// -------- faces without texture coordinates

TEST_F(Choices, FacesWithoutTextureCoordinatesAreNamedAndTheOthersBaked) {
    std::string const mesh = folder.Write(
        "two.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "usemtl skin\nf 1/1 2/2 3/3 4/4\nusemtl inner\nf 2 1 5 6\n");
    ASSERT_EQ(BakeAloud(mesh, "a.exr", {"--groups", "skin"}).status, 0);
    EXPECT_TRUE(Contains(Warning(), "1 of 2 faces have no texture coordinates")) << Warning();
    EXPECT_TRUE(Contains(Warning(), "first face 1 (line 14)")) << Warning();
    EXPECT_EQ(Report()["texels_covered"], 48 * 48);
    ExpectError(BakeAloud(mesh, "b.exr", {"--groups", "inner"}), 3, "have no texture coordinates");
    ASSERT_EQ(Limn({"info", mesh, "--json"}).status, 0);
    json const info = ParseJson(Limn({"info", mesh, "--json"}).out);
    EXPECT_EQ(info["uv"]["present"], true);
    EXPECT_EQ(info["uv"]["faces_without"], 1);
}

// -------- tiles

/// A quad whose texture coordinates reach from 0 to (u, v).
std::string MakeWideQuad(std::string const& u, std::string const& v) {
    return "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt " + u + " 0\nvt " + u + " " + v +
           "\nvt 0 " + v + "\nf 1/1 2/2 3/3 4/4\n";
}

TEST_F(Choices, TextureCoordinatesBeyondAllBoundsAreRefusedAtOnce) {
    std::string const mesh = folder.Write("far.obj", MakeWideQuad("1e30", "1e30"));
    ExpectError(BakeAloud(mesh, "a.<UDIM>.exr"), 3, "face 0 (line 9)");
    EXPECT_EQ(Limn({"info", mesh}).status, 0);
}

TEST_F(Choices, MoreThanAHundredTilesAreBakedIfTheyAreNamed) {
    std::string const mesh = folder.Write("wide.obj", MakeWideQuad("10", "10.5"));
    std::string const error = ExpectError(BakeAloud(mesh, "a.<UDIM>.exr"), 2, "--tiles");
    EXPECT_TRUE(Contains(error, "more than 100 tiles")) << error;
    EXPECT_TRUE(Contains(error, "face 0 (line 9)")) << error;
    json const info = ParseJson(Limn({"info", mesh, "--json"}).out);
    EXPECT_EQ(info["uv"]["tiles"].size(), 110u);
    ASSERT_EQ(BakeAloud(mesh, "a.<UDIM>.exr", {"--tiles", "1001-1003,1101"}).status, 0);
    EXPECT_EQ(Report()["tiles"], json({1001, 1002, 1003, 1101}));
}

TEST_F(Choices, OneTileIsBakedByItsNameWithoutAToken) {
    std::string const planes = test::AssetPath("udim/plane_3_udims.obj");
    ExpectError(BakeAloud(planes, "a.exr"), 2, "put <UDIM> into the output's name");
    ASSERT_EQ(BakeAloud(planes, "a.exr", {"--tiles", "1002"}).status, 0);
    EXPECT_EQ(Warning(), "");
    EXPECT_EQ(Report()["tiles"], json({1002}));
}

TEST_F(Choices, TokensOfOtherProgramsNameTiles) {
    ASSERT_EQ(BakeAloud(test::AssetPath("udim/plane_3_udims.obj"), "<UVTILE>.<uvtile>.exr").status,
              0);
    EXPECT_EQ(folder.List(),
              (Words{"r.json", "u1_v1.u0_v0.exr", "u2_v1.u1_v0.exr", "u3_v1.u2_v0.exr"}));
}

// -------- names

TEST_F(Choices, NamesThatSayNoExrAreRefusedBeforeWork) {
    for (char const* name : {"a", "a.tif", "{map}", "a.<UDIM>"})
        ExpectError(BakeAloud(Shape("catmark_cube"), name), 2, "maps are written as .exr");
    ExpectError(BakeAloud(Shape("catmark_cube"), "a.{tile}.exr"), 2, "no token '{tile}'");
    EXPECT_EQ(folder.List(), Words{});
}

TEST_F(Choices, TwoMeshesOfOneStemAreRefusedBeforeWork) {
    for (char const* name : {"a", "b"}) {
        fs::create_directory(folder / name);
        fs::copy(Shape("catmark_cube"), folder / (std::string(name) + "/part.obj"));
    }
    ExpectError(Limn({"bake", folder / "a/part.obj", folder / "b/part.obj", "-o",
                      folder / "{mesh}.exr", "--maps", "position"}),
                2, "two outputs are named");
    EXPECT_EQ(folder.List(), (Words{"a", "b"}));
}

TEST_F(Choices, AReportOrAnInputThatIsAnOutputIsRefusedBeforeWork) {
    std::string const mesh = folder.Write("m.obj", test::ReadText(Shape("catmark_cube")));
    ExpectError(Bake(mesh, "a.exr", {"--report", folder / "./a.exr"}), 2, "is the report");
    ExpectError(Bake(mesh, "a.<UDIM>.exr", {"--report", folder / "a.1001.exr"}), 2,
                "is the report");
    fs::create_symlink(mesh, folder / "link.exr");
    ExpectError(Bake(mesh, "link.exr"), 2, "is an input");
    EXPECT_EQ(folder.List(), (Words{"link.exr", "m.obj"}));
    EXPECT_EQ(test::ReadText(mesh), test::ReadText(Shape("catmark_cube")));
}

// -------- audits

TEST_F(Choices, AuditsOfAllMeshesAreInTheReport) {
    ASSERT_EQ(Limn({"bake", test::ScenePath("spot/spot.obj"),
                    test::ScenePath("double_torus/double_torus.obj"), "-o", folder / "{mesh}.exr",
                    "--maps", "position", "--size", "512", "--audit", "--audit-bound", "1",
                    "--report", folder / "r.json"})
                  .status,
              0);
    json const report = Report();
    ASSERT_EQ(report["audits"].size(), 2u);
    EXPECT_EQ(report["audits"][0]["mesh"], test::ScenePath("spot/spot.obj"));
    EXPECT_EQ(report["audits"][1]["mesh"], test::ScenePath("double_torus/double_torus.obj"));
    EXPECT_EQ(report["audit"]["gauss_bonnet"], report["audits"][0]["gauss_bonnet"]);
    EXPECT_NE(report["audit"]["gauss_bonnet"], report["audits"][1]["gauss_bonnet"]);
}

TEST_F(Choices, AMissedBoundIsStatus4AndTheFilesStay) {
    std::string const spot = test::ScenePath("spot/spot.obj");
    std::string const error = ExpectError(
        BakeAloud(spot, "a.exr", {"--audit", "--audit-bound", "1e-12", "--size", "512"}), 4,
        "component 0");
    EXPECT_TRUE(Contains(error, "12.5664 is expected")) << error;
    EXPECT_TRUE(Contains(error, "--size or --samples")) << error;
    EXPECT_TRUE(fs::exists(folder / "a.exr"));
    for (Words const& bound : {Words{"--seam-bound", "1e-9"},
                               {"--seam-bound", "1e9", "--seam-bound", "mean=1e-9"},
                               {"--seam-bound", "1e9,mean=1e-9"}}) {
        EXPECT_TRUE(Contains(
            ExpectError(BakeAloud(spot, "b.exr", Words{"--audit", "--size", "512"} + bound), 4,
                        "map mean"),
            "the bound is 1e-09"));
    }
    EXPECT_EQ(BakeAloud(spot, "c.exr", {"--audit", "--size", "512", "--seam-bound", "1e9"}).status,
              0);
}

// -------- types

TEST_F(Choices, HalfIsForAllMapsOrForThoseNamed) {
    std::string const spot = test::ScenePath("spot/spot.obj");
    auto const sizes = [&](Words const& more) {
        EXPECT_EQ(
            Bake(spot, "{map}.exr",
                 Words{"--maps", "normal,mean", "--size", "256", "--compression", "none"} + more)
                .status,
            0);
        return std::pair{fs::file_size(folder / "normal.exr"), fs::file_size(folder / "mean.exr")};
    };
    auto const [wideNormal, wideMean] = sizes({});
    auto const [halfNormal, halfMean] = sizes({"--half"});
    EXPECT_LT(halfNormal, 0.6 * static_cast<double>(wideNormal));
    EXPECT_LT(halfMean, 0.6 * static_cast<double>(wideMean));
    auto const [ownNormal, ownMean] = sizes({"--half=normal"});
    EXPECT_EQ(ownNormal, halfNormal);
    EXPECT_EQ(ownMean, wideMean);
    EXPECT_EQ(sizes({"--half=mean,normal"}), (std::pair{halfNormal, halfMean}));
}

TEST_F(Choices, HalfOfAMapThatIsNotBakedIsRefused) {
    ExpectError(BakeAloud(Shape("catmark_cube"), "a.exr", {"--half=normal"}), 2,
                "'normal' is no map that is baked");
}

TEST_F(Choices, ALayerOfItsOwnTypeKeepsItsValues) {
    std::string const spot = test::ScenePath("spot/spot.obj");
    Words const maps{"--maps", "position,mean"};
    ASSERT_EQ(Bake(spot, "mixed.exr", maps + Words{"--half=mean"}).status, 0);
    ASSERT_EQ(Bake(spot, "wide.exr", maps).status, 0);
    ASSERT_EQ(Bake(spot, "half.exr", maps + Words{"--half"}).status, 0);
    engine::ExrLookup lookup;
    Words const position{"position.R", "position.G", "position.B"}, mean{"mean.Y"};
    for (int x = 0; x < 64; x += 3) {
        EXPECT_EQ(lookup.Look(folder / "mixed.exr", position, x, 30),
                  lookup.Look(folder / "wide.exr", position, x, 30));
    }
    for (int x = 0; x < 64; x += 3) {
        EXPECT_EQ(lookup.Look(folder / "mixed.exr", mean, x, 30),
                  lookup.Look(folder / "half.exr", mean, x, 30));
    }
}

// -------- displacement

TEST_F(Choices, WhatScalarDisplacementLeavesOutIsInTheReport) {
    std::string const sheet =
        folder.Write("sheet.obj",
                     "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                     "f 1/1 2/2 3/3 4/4\n");
    std::string const moved =
        folder.Write("moved.obj", "v .5 0 1\nv 1.5 0 1\nv 1.5 1 1\nv .5 1 1\nf 1 2 3 4\n");
    Words const way{"--maps", "displacement", "--against", moved, "--report", folder / "r.json"};
    ASSERT_EQ(Bake(sheet, "a.exr", way).status, 0);
    json const output = Report()["outputs"][0];
    EXPECT_NEAR(output["tangential_rms"].get<double>(), 0.5, 1e-6);
    EXPECT_NEAR(output["tangential_max"].get<double>(), 0.5, 1e-6);
    EXPECT_TRUE(Contains(Warning(), "--vector bakes all of it")) << Warning();
    // A file that is left alone does not tell; an audit counts its samples all the same.
    ASSERT_EQ(Bake(sheet, "a.exr", way + Words{"--skip-existing"}).status, 0);
    EXPECT_TRUE(Report()["outputs"][0].at("tangential_rms").is_null());
    EXPECT_TRUE(Report()["outputs"][0].at("tangential_max").is_null());
    ASSERT_EQ(Bake(sheet, "a.exr", way + Words{"--skip-existing", "--audit"}).status, 0);
    EXPECT_EQ(Report()["outputs"][0]["tangential_max"], output["tangential_max"]);
    ASSERT_EQ(Bake(sheet, "a.exr", way + Words{"--vector"}).status, 0);
    EXPECT_EQ(Warning(), "");
    EXPECT_FALSE(Report()["outputs"][0].contains("tangential_rms"));
}

// -------- options without effect

struct Effectless {
    std::string name;
    Words words;
    std::string says;
};

void PrintTo(Effectless const& without, std::ostream* out) {
    *out << without.name;
}

class OptionsWithoutEffect : public testing::TestWithParam<Effectless> {};

TEST_P(OptionsWithoutEffect, AreRefused) {
    test::TemporaryFolder const folder;
    ExpectError(
        Limn(Words{"bake", Shape("catmark_cube"), "-o", folder / "a.exr"} + GetParam().words), 2,
        GetParam().says);
    EXPECT_TRUE(folder.List().empty());
}

INSTANTIATE_TEST_SUITE_P(
    Of, OptionsWithoutEffect,
    testing::Values(
        Effectless{"Vector", {"--maps", "mean", "--vector"}, "it is for displacement, bands"},
        Effectless{"Space", {"--maps", "mean", "--space", "object"}, "--space has no effect"},
        Effectless{"SpaceOfScalars", {"--maps", "bands", "--space", "tangent"}, "needs --vector"},
        Effectless{"Against", {"--maps", "mean", "--against", "x.obj"}, "it is for displacement"},
        Effectless{"Rest", {"--maps", "mean", "--rest", "x.obj"}, "it is for tension"},
        Effectless{"Bands", {"--maps", "mean", "--bands", "3"}, "it is for bands"},
        Effectless{"Field", {"--maps", "mean", "--field", "x.csv"}, "it is for field"},
        Effectless{"Normalize", {"--maps", "mean", "--normalize"}, "it is for noise, field"},
        Effectless{"NormalizeOfColours",
                   {"--maps", "noise", "--normalize", "--noise-ramp", "#000000,#ffffff"},
                   "no effect with --noise-ramp"},
        Effectless{"Seed", {"--maps", "mean,normal", "--noise-seed", "3"}, "it is for noise"},
        Effectless{"AuditBound", {"--maps", "mean", "--audit-bound", "1"}, "needs --audit"},
        Effectless{"SeamBound", {"--maps", "mean", "--seam-bound", "1"}, "needs --audit"},
        Effectless{
            "SeamBoundOfNoMap", {"--maps", "mean", "--audit", "--seam-bound", "k1=1"}, "not baked"},
        Effectless{"NegativeAuditBound",
                   {"--maps", "mean", "--audit", "--audit-bound", "-1"},
                   "--audit-bound: '-1' is no number from 0 up"},
        Effectless{"NegativeSeamBound",
                   {"--maps", "mean", "--audit", "--seam-bound", "mean=-1"},
                   "--seam-bound: '-1' is no number from 0 up"},
        Effectless{"Range", {"--maps", "mean", "--preview-range", "p1"}, "needs --preview"},
        Effectless{"View", {"--maps", "mean", "--view", "0,0,1"}, "needs --picture"},
        Effectless{"Legend", {"--maps", "mean", "--preview-legend"}, "needs --preview"}),
    [](auto const& instance) { return instance.param.name; });

}  // namespace
}  // namespace limn
