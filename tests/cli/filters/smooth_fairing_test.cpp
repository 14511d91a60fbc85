// SPDX-License-Identifier: Apache-2.0
//
// limn smooth on the mesh as it is, in steps and until it settles, from outside.

#include <filesystem>

#include "support/fit_meshes.h"
#include "support/program/cli_smooth.h"
#include "support/values.h"

namespace limn {
namespace {

using namespace test::cli;

TEST_F(CliSmooth, WithoutRefinementOneSolveIsReported) {
    auto const found = Smooth(icosa, {"--levels", "0", "--width-factor", "0.3"});
    EXPECT_EQ(found.cage.numVertices, 12);
    json const report = Report();
    ASSERT_EQ(report["levels"].size(), 1u);
    EXPECT_EQ(report["levels"][0]["level"], 0);
    EXPECT_EQ(report["levels"][0]["unknowns"], 12);
    EXPECT_FALSE(report.contains("settle_moves"));
    EXPECT_FALSE(report["levels"][0].contains("step"));
}

TEST_F(CliSmooth, StepsAndMovesAreReported) {
    Smooth(icosa, {"--levels", "1", "--steps", "3", "--settle", "1e-3"});
    json const report = Report();
    ASSERT_EQ(report["levels"].size(), 3u);
    EXPECT_EQ(report["levels"][2]["level"], 1);
    EXPECT_EQ(report["levels"][2]["step"], 3);
    ASSERT_GE(report["settle_moves"].size(), 3u);
    EXPECT_LT(report["settle_moves"].back(), 1e-3);
}

TEST_F(CliSmooth, StepsGiveTheSameBytesForAnyNumberOfThreads) {
    for (std::string const threads : {"1", "2", "4"}) {
        ASSERT_EQ(Limn({"smooth", spot, "-o", folder / (threads + ".ply"), "--levels", "3",
                        "--steps", "2", "--settle", "1e-4", "--threads", threads})
                      .status,
                  0);
    }
    EXPECT_EQ(test::ReadText(folder / "1.ply"), test::ReadText(folder / "2.ply"));
    EXPECT_EQ(test::ReadText(folder / "1.ply"), test::ReadText(folder / "4.ply"));
}

TEST_F(CliSmooth, WhatFairingRefusesIsNamed) {
    for (auto const& [words, status, message] :
         {std::tuple<Words, int, std::string>{{"--steps", "0"}, 2, "--steps"},
          {{"--settle", "0"}, 2, "--settle"},
          {{"--settle", "nan"}, 2, "--settle"},
          {{"--levels", "0"}, 3, "face 36 has 5 corners"}}) {
        ExpectError(Limn(Words{"smooth", spot, "-o", folder / "x.obj"} + words), status, message);
        EXPECT_FALSE(std::filesystem::exists(folder / "x.obj"));
    }
}

// A sphere of radius r carries r/2, and an icosahedron 0.4 of its edge.
TEST_F(CliSmooth, InfoTellsTheWidthThatAMeshCarries) {
    json const info = json::parse(Limn({"info", icosa, "--widths", "--json"}).out);
    json const& widths = info["smooth_widths"];
    EXPECT_NEAR(widths["mean_edge"].get<double>(), 2.0, 1e-6);
    EXPECT_NEAR(widths["default"].get<double>(), 0.24, 1e-6);
    EXPECT_NEAR(widths["critical"].get<double>(), 0.8, 0.01);
    EXPECT_TRUE(
        json::parse(Limn({"info", grid, "--widths", "--json"}).out)["smooth_widths"]["critical"]
            .is_null());
    EXPECT_TRUE(Contains(Limn({"info", icosa, "--widths"}).out, ", critical 0."));
    EXPECT_FALSE(json::parse(Limn({"info", icosa, "--json"}).out).contains("smooth_widths"));
}

}  // namespace
}  // namespace limn
