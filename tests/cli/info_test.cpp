// SPDX-License-Identifier: Apache-2.0
//
// limn info from outside.

#include <gtest/gtest.h>

#include "support/program/cli.h"

namespace limn {
namespace {

using namespace test::cli;

TEST_F(Cli, InfoJsonHasTheSpecifiedKeys) {
    Outcome const outcome = Limn({"info", Shape("catmark_cube_creases0"), "--json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    json const info = ParseJson(outcome.out);
    EXPECT_EQ(info["vertices"], 8);
    EXPECT_EQ(info["edges"], 12);
    EXPECT_EQ(info["faces"], 6);
    EXPECT_EQ(info["faces_by_size"], json({{"4", 6}}));
    EXPECT_EQ(info["components"], 1);
    EXPECT_EQ(info["boundary_loops"], 0);
    EXPECT_EQ(info["euler_characteristic"], 2);
    EXPECT_EQ(info["genus"], 0);
    EXPECT_EQ(info["valence"], json({{"min", 3}, {"max", 3}}));
    EXPECT_EQ(info["creases"], 2);
    EXPECT_EQ(info["corners"], 0);
    EXPECT_EQ(info["holes"], 0);
    EXPECT_TRUE(info["groups"].is_array());
    for (char const* key : {"present", "tiles", "overlap_faces", "flipped_faces", "zero_area_faces",
                            "out_of_range_faces"}) {
        EXPECT_TRUE(info["uv"].contains(key)) << key;
    }
    EXPECT_EQ(info["options"]["scheme"], "catmark");
    for (char const* key : {"boundary", "fvar", "creases", "triangles"})
        EXPECT_TRUE(info["options"].contains(key)) << key;
    EXPECT_TRUE(info["defects"].is_array());
}

TEST_F(Cli, InfoJsonNamesDefectsWithTheirLine) {
    json const info =
        ParseJson(Limn({"info", test::DataPath("malformed/nonmanifold_edge.obj"), "--json"}).out);
    EXPECT_TRUE(info["genus"].is_null());
    ASSERT_EQ(info["defects"].size(), 1u);
    for (char const* key : {"kind", "element", "line", "message"})
        EXPECT_TRUE(info["defects"][0].contains(key)) << key;
}

TEST_F(Cli, InfoTellsTheEffectiveOptions) {
    // The command line overrides the file's tags; catmark_edgenone has t interpolateboundary 0.
    auto const options = [](Words const& more) {
        return ParseJson(Limn(Words{"info", Shape("catmark_edgenone"), "--json"} + more).out)
            .at("options");
    };
    EXPECT_EQ(options({})["boundary"], "none");
    EXPECT_EQ(options({})["fvar"], "corners-plus1");
    json const other = options({"--boundary", "edge-only", "--fvar", "all", "--creases", "chaikin",
                                "--triangles", "smooth", "--scheme", "bilinear"});
    EXPECT_EQ(other, json({{"scheme", "bilinear"},
                           {"boundary", "edge-only"},
                           {"fvar", "all"},
                           {"creases", "chaikin"},
                           {"triangles", "smooth"}}));
}

TEST_F(Cli, InfoSaysWhereNoTileIsReached) {
    std::string const sheet =
        folder.Write("a.obj",
                     "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1e30 0\nvt 1e30 1\nvt 0 1\n"
                     "f 1/1 2/2 3/3 4/4\n");
    EXPECT_TRUE(Contains(Limn({"info", sheet}).out, "no tile; faces: 0 over others"));
    json const uv = ParseJson(Limn({"info", sheet, "--json"}).out)["uv"];
    EXPECT_EQ(uv["tiles"], json::array());
    EXPECT_EQ(uv["out_of_range_faces"], 1);
}

TEST_F(Cli, InfoJsonStandsNamesThatAreNotUtf8) {
    std::string const mesh =
        folder.Write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl caf\xe9\nf 1 2 3\n");
    Outcome const outcome = Limn({"info", mesh, "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(json::accept(outcome.out)) << outcome.out;
}

}  // namespace
}  // namespace limn
