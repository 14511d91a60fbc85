// SPDX-License-Identifier: Apache-2.0
//
// What limn smooth keeps, and what it warns of: collapse, volume, creases, height fields.

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "engine/io/mesh_reader.h"
#include "engine/io/mesh_writer.h"
#include "support/program/cli_smooth.h"
#include "support/values.h"

namespace limn {
namespace {

using namespace test::cli;

// [Cascade 7]: critical sigma over the mean edge, on the grid of three levels.
TEST_F(CliSmooth, AWidthThatCollapsesIsRefusedWithTheCriticalOne) {
    struct Case {
        std::string mesh;
        double critical;
    };
    std::string const tetra = folder.Write(
        "tetra.obj",
        "v 1 1 1\nv 1 -1 -1\nv -1 1 -1\nv -1 -1 1\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n");
    std::string const octa =
        folder.Write("octa.obj",
                     "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\nf 1 3 5\nf 3 2 5\nf "
                     "2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n");
    auto const cut = engine::ReadMesh(WriteCube());
    std::string cube;  // each side cut from its first corner
    for (size_t i = 0; i < 8; ++i)
        cube += fmt::format("v {} {} {}\n", cut.positions[3 * i], cut.positions[3 * i + 1],
                            cut.positions[3 * i + 2]);
    for (size_t side = 0; side < 6; ++side) {
        auto const at = [&](size_t k) { return cut.cage.faceVertices[4 * side + k] + 1; };
        cube += fmt::format("f {} {} {}\nf {} {} {}\n", at(0), at(1), at(2), at(0), at(2), at(3));
    }
    for (auto const& [mesh, critical] : {Case{tetra, 0.135}, Case{octa, 0.234}, Case{icosa, 0.400},
                                         Case{folder.Write("cut.obj", cube), 0.262}}) {
        auto const outcome =
            Limn({"smooth", mesh, "-o", folder / "x.obj", "--levels", "6", "--width-factor",
                  std::to_string(1.3 * critical), "--report", folder / "r.json"});
        ExpectError(outcome, 4, "collapses the component of vertex 0");
        EXPECT_FALSE(std::filesystem::exists(folder / "x.obj"));
        json const report = Report();
        double const found =
            report["critical_width"].get<double>() / report["mean_edge"].get<double>();
        EXPECT_NEAR(found, critical, 0.012 * critical) << mesh;
        EXPECT_LT(report["shrinkage"]["radius_ratio"], 0.5);
        // Limited, it goes through; kept, the result is there.
        EXPECT_EQ(
            Limn({"smooth", mesh, "-o", folder / "x.obj", "--levels", "3", "--width-factor",
                  std::to_string(1.3 * critical), "--limit-width", "--report", folder / "r.json"})
                .status,
            0);
        EXPECT_NEAR(Report()["largest_width"].get<double>() / Report()["mean_edge"].get<double>(),
                    0.95 * critical, 0.012 * critical);
        EXPECT_EQ(Limn({"smooth", mesh, "-o", folder / "kept.obj", "--levels", "6",
                        "--width-factor", std::to_string(1.3 * critical), "--keep-result"})
                      .status,
                  4);
        EXPECT_TRUE(test::AreFinite(engine::ReadMesh(folder / "kept.obj").positions));
        std::filesystem::remove(folder / "x.obj");
    }
    // The default width is safe for all of them.
    for (std::string const& mesh : {tetra, octa, icosa})
        EXPECT_EQ(Limn({"smooth", mesh, "-o", folder / "x.obj", "--levels", "5"}).status, 0);
}

// Two components: only the small one collapses, and it is named.
TEST_F(CliSmooth, TheComponentThatCollapsesIsNamed) {
    std::string text = test::ReadText(icosa);
    auto const small = engine::ReadMesh(icosa);
    for (size_t i = 0; i < 12; ++i)
        text += fmt::format("v {} {} {}\n", 9 + 0.2 * small.positions[3 * i],
                            0.2 * small.positions[3 * i + 1], 0.2 * small.positions[3 * i + 2]);
    for (size_t face = 0; face < 20; ++face)
        text += fmt::format("f {} {} {}\n", 13 + small.cage.faceVertices[3 * face],
                            13 + small.cage.faceVertices[3 * face + 1],
                            13 + small.cage.faceVertices[3 * face + 2]);
    auto const outcome = Limn({"smooth", folder.Write("two.obj", text), "-o", folder / "x.obj",
                               "--levels", "4", "--width", "0.5"});
    ExpectError(outcome, 4, "component of vertex 12");
}

TEST_F(CliSmooth, VolumeIsPreserved) {
    for (std::string const& mesh : {icosa, torus, WriteCube()}) {
        auto const found =
            Smooth(mesh, {"--levels", "3", "--width-factor", "0.25", "--preserve-volume"});
        json const volumes = Report()["volumes"];
        ASSERT_EQ(volumes.size(), 1u);
        EXPECT_TRUE(volumes[0]["kept"]);
        // The volume of the start mesh, by its triangles (cube: 8).
        double const expected = MeasureVolume(engine::ReadMesh(mesh));
        EXPECT_NEAR(volumes[0]["end"].get<double>(), expected, 1e-9 * std::abs(expected));
        EXPECT_NEAR(MeasureVolume(found), expected, 1e-9 * std::abs(expected));
        EXPECT_LT(MeasureVolume(Smooth(mesh, {"--levels", "3", "--width-factor", "0.25"})),
                  0.97 * expected)
            << mesh;
    }
}

// The force that keeps the volume acts where the filter does; open components have no volume to
// keep.
TEST_F(CliSmooth, VolumeIsPreservedWhereTheFilterActs) {
    std::string const cube = WriteCube(), map = folder.Write("map.csv", "vertex,width\n7,0.5\n");
    auto const found = Smooth(cube, {"--levels", "4", "--width-map", map, "--preserve-volume"});
    EXPECT_NEAR(MeasureVolume(found), 8.0, 1e-8);
    EXPECT_LT(MeasureVolume(Smooth(cube, {"--levels", "4", "--width-map", map})), 7.98);
    auto const start = Interpolate(engine::ReadMesh(cube), 4);
    int numStill = 0;
    for (size_t i = 0; i < start.size() / 3; ++i) {
        if (At(start, i).maxCoeff() > 0.99) continue;
        EXPECT_EQ(At(found.positions, i), At(start, i));
        ++numStill;
    }
    EXPECT_GT(numStill, 500);
    auto const open = Smooth(grid, {"--levels", "2", "--preserve-volume"}).positions;
    EXPECT_FALSE(Report().contains("volumes"));
    EXPECT_EQ(open, Smooth(grid, {"--levels", "2"}).positions);
}

// A cube whose edges are all creased keeps its shape to rounding; without the flag it gets round.
TEST_F(CliSmooth, CreasesAreKeptWhereAskedFor) {
    std::string const cube =
        folder.Write("creased.obj", test::ReadText(WriteCube()) +
                                        "t crease 2/1/0 4 5 10\nt crease 2/1/0 5 7 10\nt crease "
                                        "2/1/0 7 6 10\nt crease 2/1/0 6 4 10\n");
    auto const kept =
        Smooth(cube, {"--levels", "4", "--width", "0.3", "--keep-creases"}, "out.obj");
    auto const start = Interpolate(engine::ReadMesh(cube), 4);
    // The side z = 1 is bounded by the crease, a closed curve, which gets round as a curve of its
    // own; it stays in its plane, and a sharp edge.
    double sharpest = 0.0;
    for (size_t i = 0; i < start.size() / 3; ++i) {
        Vector const from = At(start, i), to = At(kept.positions, i);
        if (from.z() == 1) {
            EXPECT_NEAR(to.z(), 1.0, 1e-6);
        }
        if (from == Vector(1, 0, 1)) sharpest = to.x();
    }
    EXPECT_NEAR(sharpest, 1.0, 0.06);
    EXPECT_FALSE(kept.cage.creaseSharpness.empty());
    auto const round = Smooth(cube, {"--levels", "4", "--width", "0.3"}, "out.obj");
    EXPECT_TRUE(round.cage.creaseSharpness.empty());
    for (size_t i = 0; i < start.size() / 3; ++i) {
        if (At(start, i) == Vector(1, 0, 1)) {
            EXPECT_LT(At(round.positions, i).z(), 0.93);
        }
    }
}

TEST_F(CliSmooth, HeightFieldsKeepTheirPlane) {
    auto scene = engine::ReadMesh(grid);
    for (size_t i = 0; i < scene.positions.size(); i += 3)
        scene.positions[i + 2] = std::fmod(static_cast<double>(i), 7.0) * 0.1;
    engine::WriteMesh(folder / "heights.obj", scene, Precision::Double);
    auto const found =
        Smooth(folder / "heights.obj", {"--levels", "3", "--graph", "--width", "0.5"});
    auto const start = Interpolate(scene, 3);
    double moved = 0.0, highest = 0.0, lowest = 1.0;
    for (size_t i = 0; i < start.size(); i += 3) {
        EXPECT_EQ(found.positions[i], start[i]);
        EXPECT_EQ(found.positions[i + 1], start[i + 1]);
        moved = std::max(moved, std::abs(found.positions[i + 2] - start[i + 2]));
        highest = std::max(highest, found.positions[i + 2]);
        lowest = std::min(lowest, found.positions[i + 2]);
    }
    EXPECT_GT(moved, 0.05);
    EXPECT_LT(highest,
              0.6 + 1e-12);  // the maximum principle: triangles of this grid are not obtuse
    EXPECT_GT(lowest, -1e-12);
    ExpectError(Limn({"smooth", icosa, "-o", folder / "x.obj", "--graph"}), 3,
                "--graph needs heights");
    std::string const folded =
        folder.Write("folded.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.1 0.2 1\nf 1 2 3\nf 3 2 4\n");
    ExpectError(Limn({"smooth", folded, "-o", folder / "x.obj", "--graph"}), 3,
                "face 1 (line 6) is folded");
}

TEST_F(CliSmooth, ADegeneratingMetricIsFrozenAndSaid) {
    auto const outcome =
        Limn({"smooth", grid, "-o", folder / "x.obj", "--levels", "5", "--width-factor", "0.3",
              "--boundary-rule", "natural", "--report", folder / "r.json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(Contains(outcome.err, "keeps the metric of the level before"));
    EXPECT_TRUE(Report()["levels"].back()["frozen_metric"]);
    EXPECT_FALSE(Report()["levels"][0]["frozen_metric"]);
    EXPECT_TRUE(test::AreFinite(engine::ReadMesh(folder / "x.obj").positions));
}

// A tetrahedron's corners have 180 degrees; a tall pyramid's tip less.
TEST_F(CliSmooth, SharpCornersAreWarnedOf) {
    std::string const spike = folder.Write(
        "spike.obj",
        "v 1 0 0\nv -0.5 0.866 0\nv -0.5 -0.866 0\nv 0 0 4\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 1 3 2\n");
    auto const outcome = Limn({"smooth", spike, "-o", folder / "x.obj", "--levels", "3"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    // Three isosceles triangles of height over base sqrt(4^2 + 0.5^2) / 0.866 at the tip: 3 * 2
    // atan(0.866 / 4.031) = 72.7 degrees.
    EXPECT_TRUE(Contains(outcome.err, "vertex 3 the faces' angles add up to 72.7 degrees"))
        << outcome.err;
    EXPECT_FALSE(Contains(Limn({"smooth", icosa, "-o", folder / "x.obj"}).err, "degrees"));
}

}  // namespace
}  // namespace limn
