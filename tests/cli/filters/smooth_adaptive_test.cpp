// SPDX-License-Identifier: Apache-2.0
//
// limn smooth --adaptive, --order and --keep-features from outside.

#include <cmath>
#include <filesystem>
#include <sstream>
#include <tuple>

#include <fmt/format.h>

#include "engine/io/mesh_reader.h"
#include "support/adaptive_meshes.h"
#include "support/program/cli_smooth.h"
#include "support/values.h"

namespace limn {
namespace {

using namespace test::cli;

TEST_F(CliSmooth, AdaptiveRunsAreReported) {
    std::string const frame = test::ScenePath("window_frame/window_frame.obj");
    auto const found = Smooth(frame, {"--adaptive", "4e-3", "--width", "0.1"});
    for (auto const& [edge, count] : test::CountFacesAtEdges(found.cage.faceVertices))
        EXPECT_EQ(count, 2);
    json const report = Report();
    json const& adaptive = report["adaptive"];
    EXPECT_EQ(adaptive["asked"], 4e-3);
    EXPECT_LE(adaptive["estimated"], 1.2 * 4e-3);
    EXPECT_EQ(adaptive["vertices"], found.cage.numVertices);
    EXPECT_EQ(adaptive["passes"], report["levels"].back()["level"]);
    EXPECT_GT(adaptive["uniform_vertices"], 2 * found.cage.numVertices);
    EXPECT_GT(adaptive["smallest_edge"], 0.0);
    EXPECT_GT(adaptive["settle_moves"].size(), 0u);
    EXPECT_FALSE(report.contains("settle_moves"));
}

// Without --levels it may go eight deep, by bisection.
TEST_F(CliSmooth, TheReportOfAnAdaptiveRunHasTheDepthInEffect) {
    Words const adaptive{"--adaptive", "1e-2", "--width-factor", "0.2"};
    Smooth(icosa, adaptive);
    EXPECT_EQ(Report()["effective_options"]["levels"], 8);
    EXPECT_EQ(Report()["effective_options"]["refinement"], "bisect");
    Smooth(icosa, adaptive + Words{"--levels", "3"});
    EXPECT_EQ(Report()["effective_options"]["levels"], 3);
    Smooth(icosa, {"--levels", "1"});
    EXPECT_EQ(Report()["effective_options"]["refinement"], "quadrisect");
}

/// The cube with textures, of two triangles a side.
std::string TriangulateCube() {
    std::string text;
    for (std::string const& line : Lines(test::ReadText(test::ScenePath("cube/cube.obj")))) {
        std::istringstream words(line);
        std::string key, a, b, c, d;
        words >> key >> a >> b >> c >> d;
        text +=
            key != "f" ? line + "\n" : fmt::format("f {0} {1} {2}\nf {0} {2} {3}\n", a, b, c, d);
    }
    return text;
}

TEST_F(CliSmooth, AdaptiveTakesPaintedWidths) {
    std::string const cube = folder.Write("triangles.obj", TriangulateCube()),
                      white = folder.Write("white.pgm", "P2 1 1 255\n255\n"),
                      black = folder.Write("black.pgm", "P2 1 1 255\n0\n");
    Words const adaptive{"--adaptive", "1e-2", "--width", "0.3"};
    auto const plain = Smooth(cube, adaptive),
               allWhite = Smooth(cube, adaptive + Words{"--width-texture", white}, "white.ply"),
               allBlack = Smooth(cube, adaptive + Words{"--width-texture", black}, "black.ply");
    ASSERT_EQ(allWhite.positions.size(), plain.positions.size());
    EXPECT_LT(test::LargestDifference(allWhite.positions, plain.positions), 1e-6);
    // Without a width nothing moves, and what does not move needs no triangles.
    EXPECT_EQ(allBlack.positions, engine::ReadMesh(cube).positions);
}

/// A sheet of 4 x 4 squares, folded at x = 0, that fills the texture.
std::string WriteFoldedSheet() {
    std::string vertices, textures, faces;
    for (int j = 0; j <= 4; ++j) {
        for (int i = 0; i <= 4; ++i) {
            vertices += fmt::format("v {} {} {}\n", i - 2, j - 2, 2 - std::abs(i - 2));
            textures += fmt::format("vt {} {}\n", 0.25 * i, 0.25 * j);
            if (i == 4 || j == 4) continue;
            int const a = 5 * j + i + 1, b = a + 1, c = b + 5, d = a + 5;
            faces +=
                fmt::format("f {0}/{0} {1}/{1} {2}/{2}\nf {0}/{0} {2}/{2} {3}/{3}\n", a, b, c, d);
        }
    }
    return vertices + textures + faces;
}

// From black to white along the fold, which so becomes rounder. The law is that of all adaptive
// runs: the error asked for, and a third of what the last two uniform levels differ by.
TEST_F(CliSmooth, AdaptiveIsNearUniformWhereWidthsArePainted) {
    std::string const sheet = folder.Write("sheet.obj", WriteFoldedSheet()),
                      ramp = folder.Write("ramp.pgm", "P2 1 4 255\n255\n170\n85\n0\n");
    Words const painted{"--width", "0.4", "--width-texture", ramp};
    auto const found = Smooth(sheet, painted + Words{"--adaptive", "8e-3"}),
               finer = Smooth(sheet, painted + Words{"--levels", "2", "--settle", "1e-3"}),
               finest = Smooth(sheet, painted + Words{"--levels", "3", "--settle", "1e-3"});
    double const reach = 0.5, diagonal = 6.0;
    EXPECT_LT(found.cage.numVertices, finest.cage.numVertices);
    EXPECT_LE(test::FindLargestDistance(found, finest, reach),
              8e-3 * diagonal + test::FindLargestDistance(finer, finest, reach) / 3);
}

TEST_F(CliSmooth, AdaptiveRunsHaveTheSameBytesForAnyNumberOfThreads) {
    for (std::string const threads : {"1", "2", "4"}) {
        ASSERT_EQ(Limn({"smooth", icosa, "-o", folder / (threads + ".ply"), "--adaptive", "1e-3",
                        "--width-factor", "0.2", "--threads", threads})
                      .status,
                  0);
    }
    EXPECT_EQ(test::ReadText(folder / "1.ply"), test::ReadText(folder / "2.ply"));
    EXPECT_EQ(test::ReadText(folder / "1.ply"), test::ReadText(folder / "4.ply"));
}

TEST_F(CliSmooth, ADepthThatIsNotEnoughIsASuccessWithAWarning) {
    auto const outcome = Limn({"smooth", icosa, "-o", folder / "x.ply", "--adaptive", "1e-4",
                               "--levels", "1", "--width-factor", "0.2"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(Contains(outcome.err, "more --levels")) << outcome.err;
}

// 20 % of 1 / mean edge is the number itself; three steps are the default.
TEST_F(CliSmooth, FeaturesAreKeptByALengthOrAShare) {
    Words const words{"--levels", "0", "--width-factor", "0.2"};
    auto const byShare = Smooth(icosa, words + Words{"--keep-features", "20%"}),
               byLength = Smooth(icosa, words + Words{"--keep-features", "0.1", "--steps", "3"});
    EXPECT_EQ(Report()["levels"].size(), 3u);
    EXPECT_LT(test::LargestDifference(byShare.positions, byLength.positions), 1e-7);
}

TEST_F(CliSmooth, WhatDoesNotGoTogetherIsNamed) {
    std::string const cube = WriteCube();
    for (auto const& [words, status, message] :
         {std::tuple<Words, int, std::string>{{"--order", "4"}, 2, "--order 4 needs --levels 0"},
          {{"--order", "3", "--levels", "0"}, 2, "--order: 3 is neither 2 nor 4"},
          {{"--order", "4", "--levels", "0", "--boundary-rule", "natural"},
           2,
           "--order 4 does not go with --boundary-rule natural"},
          {{"--order", "4", "--levels", "0", "--solver", "jacobi"}, 2, "--solver jacobi"},
          {{"--order", "4", "--levels", "0", "--keep-features", "1"},
           2,
           "--order 4 and --keep-features exclude"},
          {{"--keep-features", "10%"}, 2, "--keep-features needs --levels 0"},
          {{"--keep-features", "-1", "--levels", "0"}, 2, "--keep-features"},
          {{"--keep-features", "%", "--levels", "0"}, 2, "--keep-features"},
          {{"--keep-features", "nan", "--levels", "0"}, 2, "--keep-features"},
          {{"--keep-features", "1", "--levels", "0"}, 3, "--keep-features needs triangles"},
          {{"--keep-features", "1", "--levels", "0", "--graph"}, 2, "--graph"},
          {{"--adaptive", "0"}, 2, "--adaptive"},
          {{"--adaptive", "nan"}, 2, "--adaptive"},
          {{"--adaptive", "1e-3", "--refinement", "quadrisect"},
           2,
           "--refinement quadrisect and --adaptive exclude"},
          {{"--adaptive", "1e-3", "--levels", "0"}, 2, "--levels: 0 is not from 1 to 10"},
          {{"--adaptive", "1e-3", "--levels", "11"}, 2, "--levels: 11"},
          {{"--adaptive", "1e-3", "--steps", "2"}, 2, "--adaptive and --steps exclude"},
          {{"--adaptive", "1e-3", "--settle", "1e-3"}, 2, "--adaptive and --settle exclude"},
          {{"--adaptive", "1e-3", "--sweeps", "3"}, 2, "--adaptive and --sweeps exclude"},
          {{"--adaptive", "1e-3", "--solver", "jacobi"}, 2, "--solver jacobi"},
          {{"--adaptive", "1e-3"}, 3, "4 corners; --adaptive needs triangles"}}) {
        ExpectError(Limn(Words{"smooth", cube, "-o", folder / "x.obj"} + words), status, message);
        EXPECT_FALSE(std::filesystem::exists(folder / "x.obj"));
    }
}

}  // namespace
}  // namespace limn
