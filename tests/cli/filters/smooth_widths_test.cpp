// SPDX-License-Identifier: Apache-2.0
//
// Widths of limn smooth: on edges, from tables and from images.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/io/mesh_reader.h"
#include "engine/io/mesh_writer.h"
#include "support/fit_meshes.h"
#include "support/program/cli_smooth.h"
#include "support/refined.h"
#include "support/values.h"

namespace limn {
namespace {

using namespace test::cli;

TEST_F(CliSmooth, WidthOnEdgesRoundsThemAndLeavesTheRestToTheBit) {
    std::string const cube = WriteCube(),
                      edges = folder.Write("edges.csv",
                                           "v0,v1,width\n5,7,0.2\n");  // the edge x = z = 1
    auto const found = Smooth(cube, {"--levels", "5", "--width-edges", edges});
    auto const start = Interpolate(engine::ReadMesh(cube), 5);
    auto const widths = GetWidths(found);
    int numMoved = 0;
    double deepest = 0.0;
    for (size_t i = 0; i < found.positions.size() / 3; ++i) {
        Vector const from = At(start, i), to = At(found.positions, i);
        double const distance = std::hypot(from.x() - 1.0, from.z() - 1.0);
        // 0.2 up to a distance of one width, none beyond three; the finest edges are 1/16 long.
        if (distance <= 0.2) {
            EXPECT_FLOAT_EQ(widths[i], 0.2f);
        }
        if (distance > 0.5 && distance < 0.59) {
            EXPECT_GT(widths[i], 0.0f);
        }
        if (distance >= 0.6) {
            EXPECT_EQ(widths[i], 0.0f);
        }
        if (distance >= 0.6 + 0.1) {
            EXPECT_EQ(from, to) << i;
        }
        numMoved += from != to;
        deepest = std::max(deepest, (to - from).norm());
    }
    EXPECT_GT(numMoved, 500);
    EXPECT_GT(deepest, 0.05);
    EXPECT_LT(deepest, 0.25);
    // Centres of the sides, that of the rounded ones too.
    for (size_t i = 8; i < 14; ++i) EXPECT_EQ(At(start, i), At(found.positions, i));
}

// Along a straight edge of 90 degrees the profile is that of a 2-D wedge: it does not depend on the
// mesh. Coarse cube and one with six times as many faces along the edge, in the middle of the edge.
TEST_F(CliSmooth, TheRoundingIsTheSameOnFinerMeshes) {
    std::string const cube = WriteCube(),
                      edges = folder.Write("edges.csv", "v0,v1,width\n5,7,0.2\n");
    auto const middle = [](engine::Scene const& scene) {
        Vector best(0, 0, 0);
        for (size_t i = 0; i < scene.positions.size() / 3; ++i) {
            Vector const p = At(scene.positions, i);
            if (std::abs(p.y()) < 1e-3 && std::abs(p.x() - p.z()) < 1e-6 && p.x() > best.x())
                best = p;
        }
        return best;
    };
    auto const coarse = Smooth(cube, {"--levels", "6", "--width-edges", edges});
    ASSERT_EQ(
        Limn({"refine", cube, "-o", folder / "fine.obj", "--levels", "1", "--scheme", "bilinear"})
            .status,
        0);
    auto const fine = engine::ReadMesh(folder / "fine.obj");
    std::string text = "v0,v1,width\n";
    auto const refiner = test::MakeRefiner(fine, 0);
    for (Index edge = 0; edge < refiner->GetLevel(0).GetNumEdges(); ++edge) {
        auto const ends = refiner->GetLevel(0).GetEdgeVertices(edge);
        Vector const p = At(fine.positions, static_cast<size_t>(ends[0])),
                     q = At(fine.positions, static_cast<size_t>(ends[1]));
        if (p.x() == 1 && q.x() == 1 && p.z() == 1 && q.z() == 1)
            text += fmt::format("{},{},0.2\n", ends[0], ends[1]);
    }
    auto const again = Smooth(folder / "fine.obj",
                              {"--levels", "5", "--width-edges", folder.Write("fine.csv", text)});
    EXPECT_GT(middle(coarse).x(), 0.8);
    EXPECT_NEAR(middle(coarse).x(), middle(again).x(), 2e-3);
}

TEST_F(CliSmooth, PaintedWidthFromATable) {
    std::string const cube = WriteCube();
    auto const found = Smooth(
        cube, {"--levels", "4", "--width-map", folder.Write("map.csv", "vertex,width\n7,0.5\n")});
    auto const start = Interpolate(engine::ReadMesh(cube), 4);
    auto const widths = GetWidths(found);
    // Vertex 7 and the three sides around it; the three opposite ones have no width at any corner
    // but on shared edges.
    EXPECT_GT((At(found.positions, 7) - At(start, 7)).norm(), 0.1);
    EXPECT_GT(widths[7], 0.2f);
    int numOpposite = 0;
    for (size_t i = 0; i < widths.size(); ++i) {
        Vector const p = At(start, i);
        if (p.maxCoeff() > 0.99) continue;  // on one of the three sides
        EXPECT_EQ(At(found.positions, i), p);
        ++numOpposite;
    }
    EXPECT_GT(numOpposite, 500);
    // Table and option mean the same where every vertex has the same width, up to the filter on
    // widths, which keeps constants.
    std::string text = "vertex,width\n";
    for (int i = 0; i < 8; ++i) text += fmt::format("{},0.3\n", i);
    auto const same = Smooth(cube, {"--levels", "3", "--width-map", folder.Write("all.csv", text),
                                    "--tolerance", "1e-12"});
    EXPECT_LT(
        test::LargestDifference(
            same.positions,
            Smooth(cube, {"--levels", "3", "--width", "0.3", "--tolerance", "1e-12"}).positions),
        1e-10);
}

TEST_F(CliSmooth, PaintedWidthFromAnImage) {
    // Twenty pixels per side, so that none's texture lies between two sides' pixels; only the side
    // z = 1, the second, is white.
    std::string pixels = "P2 120 1 255\n";
    for (int x = 0; x < 120; ++x) pixels += x / 20 == 1 ? "255 " : "0 ";
    std::string const cube = WriteCube(), image = folder.Write("white.pgm", pixels + "\n");
    auto const found = Smooth(cube, {"--levels", "4", "--width-texture", image, "--width", "0.4"});
    auto const widths = GetWidths(found);
    auto const start = Interpolate(engine::ReadMesh(cube), 4);
    int numInside = 0, numBelow = 0;
    for (size_t i = 0; i < widths.size(); ++i) {
        Vector const p = At(start, i);
        bool const isInside = p.z() == 1 && std::abs(p.x()) < 0.5 && std::abs(p.y()) < 0.5;
        numInside += isInside;
        numBelow += p.z() < 0.8;
        if (isInside) {
            EXPECT_NEAR(widths[i], 0.4, 1e-6);
        }
        if (p.z() < 0.8) {
            EXPECT_EQ(At(found.positions, i), p);
        }
    }
    EXPECT_EQ(numInside, 7 * 7);
    EXPECT_GT(numBelow, 1000);
    // On the side's border the mean of two or three corners: white and black.
    bool hasEdge = false;
    for (size_t i = 0; i < widths.size(); ++i) hasEdge |= std::abs(widths[i] - 0.2f) < 0.05f;
    EXPECT_TRUE(hasEdge);
    // Rows come from the top, where v is 1 (that side's y = 1).
    std::string const upper = folder.Write("upper.pgm", "P2 1 4 255\n255 255 0 0\n");
    auto const half =
        GetWidths(Smooth(cube, {"--levels", "4", "--width-texture", upper, "--width", "0.4"}));
    int numHalf = 0;
    for (size_t i = 0; i < half.size(); ++i) {
        Vector const p = At(start, i);
        if (p.z() < 1 || std::abs(p.x()) == 1 || std::abs(p.y()) < 0.5 || std::abs(p.y()) == 1)
            continue;
        EXPECT_NEAR(half[i], p.y() > 0 ? 0.4 : 0.0, 1e-6);
        ++numHalf;
    }
    EXPECT_EQ(numHalf, 15 * 8);
    // Values of an image of constant white are the width itself.
    std::string const white = folder.Write("all.pgm", "P2 1 1 255\n255\n");
    EXPECT_LT(
        test::LargestDifference(
            Smooth(cube, {"--levels", "3", "--width-texture", white, "--width", "0.3"}).positions,
            Smooth(cube, {"--levels", "3", "--width", "0.3"}).positions),
        1e-6);
}

TEST_F(CliSmooth, TilesHaveImagesOfTheirOwn) {
    std::string text = test::ReadText(WriteCube());
    // The side z = 1 (values 5 to 8) moves to tile 1012.
    for (auto const& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        std::string const from =
                              fmt::format("vt {} {}\n", (1 + 0.05 + 0.9 * u) / 6, 0.05 + 0.9 * v),
                          to = fmt::format("vt {} {}\n", 1.1 + 0.8 * u, 1.1 + 0.8 * v);
        text.replace(text.find(from), from.size(), to);
    }
    std::string const cube = folder.Write("tiles.obj", text);
    folder.Write("w.1001.pgm", "P2 1 1 255\n0\n");
    folder.Write("w.1012.pgm", "P2 1 1 255\n255\n");
    auto const found = Smooth(
        cube, {"--levels", "2", "--width-texture", folder / "w.<UDIM>.pgm", "--width", "0.4"});
    auto const widths = GetWidths(found);
    auto const start = Interpolate(engine::ReadMesh(cube), 2);
    int numAbove = 0;
    for (size_t i = 0; i < widths.size(); ++i) {
        Vector const p = At(start, i);
        bool const isOnEdge = std::abs(p.x()) == 1 || std::abs(p.y()) == 1;
        if (p.z() == 1 && !isOnEdge) {
            EXPECT_FLOAT_EQ(widths[i], 0.4f);
            ++numAbove;
        }
        if (p.z() < 1) {
            EXPECT_EQ(widths[i], 0.0f);
        }
    }
    EXPECT_EQ(numAbove, 3 * 3);
}

TEST_F(CliSmooth, AMeshThatNoTileHoldsCannotBePainted) {
    auto const run = [&](std::string const& image, double u) {
        std::string const sheet = folder.Write(
            "sheet.obj", fmt::format("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt {0} 0\nvt {0} 1\n"
                                     "f 1/1 2/1 3/2 4/2\n",
                                     u));
        return Limn({"smooth", sheet, "-o", folder / "a.obj", "--levels", "1", "--width-texture",
                     folder / image, "--width", "0.4"});
    };
    folder.Write("w.pgm", "P2 1 1 255\n255\n");
    for (double u : {1e30, 1.5}) ExpectError(run("w.pgm", u), 3, "no face lies in tile 1001;");
    ExpectError(run("w.<UDIM>.pgm", 1e30), 3, "no face lies in tile 1001 or in a tile");
    ExpectError(run("w.<UDIM>.pgm", 1.5), 5, "in a tile that has an image");
}

}  // namespace
}  // namespace limn
