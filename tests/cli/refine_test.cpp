// SPDX-License-Identifier: Apache-2.0
//
// limn refine from outside.

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/io/mesh_reader.h"
#include "support/program/cli.h"

namespace limn {
namespace {

using namespace test::cli;

TEST_F(Cli, RefinedCountsFollowFromTheRules) {
    // Quads: V' = V + E + F, E' = 2E + 4F, F' = 4F. Triangles: V' = V + E, E' = 2E + 3F, F' = 4F.
    struct Row {
        std::string shape, scheme;
        int levels;
        Index vertices, faces;
    };
    for (Row const& row : {Row{"catmark_cube", "catmark", 0, 8, 6},
                           {"catmark_cube", "catmark", 1, 26, 24},
                           {"catmark_cube", "catmark", 2, 98, 96},
                           {"loop_icosahedron", "loop", 1, 42, 80},
                           {"loop_icosahedron", "loop", 2, 162, 320}}) {
        for (std::string const ending : {".obj", ".ply"}) {
            std::string const path = folder / "a" + ending;
            Outcome const outcome =
                Limn({"refine", Shape(row.shape), "-o", path, "--scheme", row.scheme, "--levels",
                      std::to_string(row.levels), "--report", folder / "r.json"});
            ASSERT_EQ(outcome.status, 0) << outcome.err;
            engine::Scene const scene = engine::ReadMesh(path);
            EXPECT_EQ(scene.cage.numVertices, row.vertices) << row.shape << row.levels << ending;
            EXPECT_EQ(scene.cage.GetNumFaces(), row.faces) << row.shape << row.levels << ending;
            EXPECT_TRUE(scene.HasUVs());
            EXPECT_EQ(Report()["vertices"], row.vertices);
        }
    }
}

TEST_F(Cli, LevelZeroIsTheInputItself) {
    ASSERT_EQ(Limn({"refine", Shape("catmark_bishop"), "-o", folder / "a.obj", "--levels", "0",
                    "--precision", "double"})
                  .status,
              0);
    engine::Scene const before = engine::ReadMesh(Shape("catmark_bishop")),
                        after = engine::ReadMesh(folder / "a.obj");
    EXPECT_EQ(before.positions, after.positions);
    EXPECT_EQ(before.cage.faceVertices, after.cage.faceVertices);
    EXPECT_EQ(before.uvs, after.uvs);
}

TEST_F(Cli, TwoLevelsAreOneLevelTwice) {
    // Tags, rules and UVs are written out, so a refined file refines on as if it had never been
    // one.
    for (std::string const shape :
         {"catmark_cube_creases0", "catmark_edgenone", "catmark_hole_test1", "catmark_chaikin0"}) {
        auto const refine = [&](std::string const& from, std::string const& to,
                                std::string const& levels) {
            ASSERT_EQ(Limn({"refine", from, "-o", folder / to, "--levels", levels, "--precision",
                            "double", "--quiet"})
                          .status,
                      0);
        };
        refine(Shape(shape), "two.obj", "2");
        refine(Shape(shape), "one.obj", "1");
        refine(folder / "one.obj", "again.obj", "1");
        engine::Scene const two = engine::ReadMesh(folder / "two.obj"),
                            again = engine::ReadMesh(folder / "again.obj");
        ASSERT_EQ(two.positions.size(), again.positions.size()) << shape;
        // As point sets: the order within a level follows from how edges were numbered.
        auto const sorted = [](engine::Scene const& scene) {
            std::vector<std::array<double, 3>> points;
            for (size_t i = 0; i < scene.positions.size(); i += 3)
                points.push_back(
                    {scene.positions[i], scene.positions[i + 1], scene.positions[i + 2]});
            for (auto& point : points) {
                for (double& x : point) x = std::round(x * 1e9) / 1e9 + 0.0;
            }
            std::sort(points.begin(), points.end());
            return points;
        };
        EXPECT_EQ(sorted(two), sorted(again)) << shape;
        EXPECT_EQ(two.cage.holes.size(), again.cage.holes.size()) << shape;
    }
}

}  // namespace
}  // namespace limn
