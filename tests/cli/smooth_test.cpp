// SPDX-License-Identifier: Apache-2.0
//
// limn smooth from outside, and the bakes of what it makes.

#include <chrono>
#include <cmath>
#include <filesystem>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "engine/images/exr_lookup.h"
#include "engine/io/mesh_reader.h"
#include "engine/io/mesh_writer.h"
#include "support/cli.h"
#include "support/fit_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using namespace test::cli;
using Vector = Eigen::Vector3d;

class CliSmooth : public Cli {
protected:
    std::string spot = test::ScenePath("spot/spot.obj"),
                icosa = test::DataPath("cascade/icosa.obj"),
                grid = test::DataPath("cascade/gridholetri.obj"),
                torus = test::DataPath("cascade/torustri.obj");

    /// A cube from -1 to 1 with a texture of its own per side, side by side along u.
    std::string WriteCube() const {
        std::string text;
        for (int i = 0; i < 8; ++i)
            text += fmt::format("v {} {} {}\n", i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        int const faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                 {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}};
        for (int side = 0; side < 6; ++side) {
            for (auto const& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
                text += fmt::format("vt {} {}\n", (side + 0.05 + 0.9 * u) / 6, 0.05 + 0.9 * v);
        }
        for (int side = 0; side < 6; ++side) {
            text += fmt::format("g side{}\nf", side);
            for (int k = 0; k < 4; ++k)
                text += fmt::format(" {}/{}", faces[side][k] + 1, 4 * side + k + 1);
            text += "\n";
        }
        return folder.Write("cube.obj", text);
    }

    /// Runs limn smooth in double; the result.
    engine::Scene Smooth(std::string const& mesh, Words const& options,
                         std::string const& output = "out.ply") const {
        auto const outcome = Limn(Words{"smooth", mesh, "-o", folder / output, "--precision",
                                        "double", "--report", folder / "r.json"} +
                                  options);
        if (outcome.status != 0) throw std::runtime_error(outcome.err);
        return engine::ReadMesh(folder / output);
    }

    /// The start mesh on a level: vertices stay, edges are halved, quads get their centre.
    static std::vector<double> Interpolate(engine::Scene scene, int levels) {
        bool const isLoop = std::all_of(scene.cage.faceSizes.begin(), scene.cage.faceSizes.end(),
                                        [](int size) { return size == 3; });
        scene.cage.scheme = isLoop ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK;
        auto const refiner = test::MakeRefiner(scene, levels);
        std::vector<double> points = scene.positions;
        for (int level = 1; level <= levels; ++level) {
            auto const coarse = refiner->GetLevel(level - 1);
            std::vector<double> fine(
                3 * static_cast<size_t>(refiner->GetLevel(level).GetNumVertices()), 0.0);
            auto const put = [&](Index child, auto const& parents) {
                for (size_t c = 0; c < 3; ++c) {
                    double& value = fine[3 * static_cast<size_t>(child) + c];
                    for (Index parent : parents)
                        value += points[3 * static_cast<size_t>(parent) + c];
                    value /= parents.size();
                }
            };
            for (Index i = 0; i < coarse.GetNumVertices(); ++i)
                std::copy_n(&points[3 * static_cast<size_t>(i)], 3,
                            &fine[3 * static_cast<size_t>(coarse.GetVertexChildVertex(i))]);
            for (Index i = 0; i < coarse.GetNumEdges(); ++i)
                put(coarse.GetEdgeChildVertex(i), coarse.GetEdgeVertices(i));
            for (Index i = 0; !isLoop && i < coarse.GetNumFaces(); ++i)
                put(coarse.GetFaceChildVertex(i), coarse.GetFaceVertices(i));
            points = fine;
        }
        return points;
    }
};

Vector At(std::vector<double> const& points, size_t i) {
    return Vector(&points[3 * i]);
}

/// By the triangles of both ways to cut a face into a fan from its first or last corner, half each:
/// quads' both diagonals.
double MeasureVolume(engine::Scene const& scene) {
    double volume = 0.0;
    size_t corner = 0;
    for (int size : scene.cage.faceSizes) {
        for (int first : {0, size - 1}) {
            auto const at = [&](int i) {
                return At(
                    scene.positions,
                    static_cast<size_t>(
                        scene.cage.faceVertices[corner + static_cast<size_t>((first + i) % size)]));
            };
            for (int k = 1; k + 1 < size; ++k) volume += at(0).dot(at(k).cross(at(k + 1))) / 12;
        }
        corner += static_cast<size_t>(size);
    }
    return volume;
}

std::vector<float> GetWidths(engine::Scene const& scene) {
    for (auto const& primvar : scene.primvars) {
        if (primvar.name == "width") return primvar.values;
    }
    ADD_FAILURE() << "no width";
    return std::vector<float>(scene.positions.size() / 3, 0.0f);
}

TEST_F(CliSmooth, MeetsTheReferences) {
    struct Case {
        std::string mesh;
        Words options;
        std::string reference;
        double tolerance;  // of the diagonal
    };
    std::vector<Case> cases;
    for (auto const& [mesh, levels] :
         {std::pair{"icosa", 3}, {"torustri", 2}, {"gridholetri", 3}}) {
        std::string const name = mesh;
        Words const natural{"--levels", std::to_string(levels), "--boundary-rule", "natural"};
        auto const file = [&](char const* what) {
            return fmt::format("{}_cas_{}_L{}", name, what, levels);
        };
        cases.push_back({name, natural + Words{"--solver", "exact"}, file("exact"), 1e-8});
        cases.push_back(
            {name, natural + Words{"--solver", "jacobi", "--sweeps", "1"}, file("jacobi"), 1e-10});
        cases.push_back(
            {name, natural + Words{"--solver", "cg", "--sweeps", "1"}, file("cg"), 1e-6});
        cases.push_back(
            {name, natural + Words{"--solver", "exact", "--local"}, file("local12"), 1e-8});
        cases.push_back({name,
                         {"--levels", "4", "--boundary-rule", "natural", "--refinement", "bisect",
                          "--solver", "exact"},
                         name + "_cas_bisect_L4",
                         1e-8});
    }
    cases.push_back(
        {"gridholetri", {"--levels", "3", "--solver", "exact"}, "gridholetri_cas_fix_L3", 1e-8});
    for (auto const& [mesh, options, reference, tolerance] : cases) {
        auto const found = Smooth(test::DataPath("cascade/" + mesh + ".obj"), options, "out.obj");
        auto const golden = test::LoadPoints("cascade/" + reference + ".obj");
        EXPECT_LT(test::LargestDifference(found.positions, golden) / test::BoxDiagonal(golden),
                  tolerance)
            << reference;
    }
}

TEST_F(CliSmooth, WithoutWidthItRefinesLinearly) {
    for (std::string const& mesh : {spot, icosa, grid, WriteCube()}) {
        for (Words const& solver :
             {Words{"--solver", "cg"}, Words{"--solver", "jacobi"}, Words{"--solver", "exact"}}) {
            auto const found = Smooth(mesh, Words{"--width", "0", "--levels", "2"} + solver);
            EXPECT_EQ(
                test::LargestDifference(found.positions, Interpolate(engine::ReadMesh(mesh), 2)),
                0.0)
                << mesh;
        }
    }
    // And that is what OpenSubdiv's bilinear rule makes of quads.
    auto scene = engine::ReadMesh(spot);
    scene.cage.scheme = Sdc::SCHEME_BILINEAR;
    EXPECT_LT(test::LargestDifference(Smooth(spot, {"--width", "0", "--levels", "2"}).positions,
                                      test::Refine(scene, 2).positions),
              1e-15);
}

TEST_F(CliSmooth, KeepsTopologyTexturesAndGroups) {
    ASSERT_EQ(Limn({"refine", spot, "-o", folder / "refined.obj", "--levels", "2", "--precision",
                    "double"})
                  .status,
              0);
    auto const refined = engine::ReadMesh(folder / "refined.obj"),
               found = Smooth(spot, {"--levels", "2"}, "out.obj");
    EXPECT_EQ(found.cage.faceVertices, refined.cage.faceVertices);
    EXPECT_EQ(found.cage.faceSizes, refined.cage.faceSizes);
    EXPECT_EQ(found.cage.fvarChannels[0].valueIndices, refined.cage.fvarChannels[0].valueIndices);
    EXPECT_LT(test::LargestDifference(found.uvs, refined.uvs), 1e-15);
    auto const cube = Smooth(WriteCube(), {"--levels", "1"}, "out.obj");
    auto const& groups = cube.groups[static_cast<size_t>(engine::GroupKind::Group)];
    ASSERT_EQ(groups.faceGroup.size(), 24u);
    for (size_t face = 0; face < 24; ++face)
        EXPECT_EQ(groups.names[groups.faceGroup[face]], fmt::format("side{}", face / 4));
    // Triangles stay triangles; a scheme that is asked for makes them quads.
    EXPECT_EQ(Smooth(icosa, {"--levels", "1"}).cage.faceSizes[0], 3);
    EXPECT_EQ(Smooth(icosa, {"--levels", "1", "--scheme", "catmark"}).cage.faceSizes[0], 4);
}

// Half a square pyramid's faces carry holes, groups and textures through two bisections.
TEST_F(CliSmooth, BisectionCarriesTexturesGroupsAndHoles) {
    std::string const mesh =
        folder.Write("square.obj",
                     "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\n"
                     "g a\nf 1/1 2/2 3/3\ng b\nf 1/1 3/3 4/4\nt hole 1/0/0 1\n");
    auto const found =
        Smooth(mesh, {"--levels", "3", "--refinement", "bisect", "--width", "0"}, "out.obj");
    // Three passes make 2 * 2^3 triangles of two, whose areas add up to 1; texture is the place
    // with u halved.
    ASSERT_EQ(found.cage.GetNumFaces(), 16);
    double area = 0.0;
    auto const& groups = found.groups[static_cast<size_t>(engine::GroupKind::Group)];
    for (size_t face = 0; face < 16; ++face) {
        Vector p[3];
        for (size_t k = 0; k < 3; ++k) {
            size_t const vertex = static_cast<size_t>(found.cage.faceVertices[3 * face + k]),
                         value = static_cast<size_t>(
                             found.cage.fvarChannels[0].valueIndices[3 * face + k]);
            p[k] = At(found.positions, vertex);
            EXPECT_EQ(found.uvs[2 * value], p[k].x() / 2);
            EXPECT_EQ(found.uvs[2 * value + 1], p[k].y());
        }
        double const own = (p[1] - p[0]).cross(p[2] - p[0]).z() / 2;
        area += own;
        EXPECT_EQ(own, 1.0 / 16);
        Vector const middle = (p[0] + p[1] + p[2]) / 3;
        EXPECT_EQ(groups.names[groups.faceGroup[face]], middle.x() > middle.y() ? "a" : "b");
        bool const isHole = std::find(found.cage.holes.begin(), found.cage.holes.end(),
                                      static_cast<Index>(face)) != found.cage.holes.end();
        EXPECT_EQ(isHole, middle.x() < middle.y());
    }
    EXPECT_EQ(area, 1.0);
    ExpectError(Limn({"smooth", spot, "-o", folder / "x.obj", "--refinement", "bisect"}), 3,
                "bisect needs triangles");
}

TEST_F(CliSmooth, ReportTellsOfEachLevel) {
    auto const found = Smooth(icosa, {"--levels", "3", "--width-factor", "0.15"});
    json const report = Report();
    ASSERT_EQ(report["levels"].size(), 3u);
    // Vertices of an icosahedron's levels: 10 * 4^k + 2. Counts of a reference: 2, 5, 10.
    int const counts[] = {2, 5, 10};
    for (size_t k = 0; k < 3; ++k) {
        json const& level = report["levels"][k];
        EXPECT_EQ(level["unknowns"], 10 * (4 << (2 * k)) + 2);
        EXPECT_NEAR(level["sweeps"].get<int>(), counts[k], 1);
        EXPECT_LE(level["residual"], 1e-6);
        EXPECT_GT(level["min_angle_degrees"], 50.0);
        EXPECT_FALSE(level["frozen_metric"]);
    }
    EXPECT_TRUE(report["converged"]);
    EXPECT_NEAR(report["mean_edge"].get<double>(), 2.0, 1e-6);
    EXPECT_NEAR(report["largest_width"].get<double>(), 0.3, 1e-6);
    for (float width : GetWidths(found)) EXPECT_FLOAT_EQ(width, 0.3f);
    // The a-priori rule: n 4^(kmax - k) sweeps, and as many as asked for on each level.
    Smooth(icosa, {"--levels", "3", "--solver", "jacobi", "--sweeps", "2"});
    EXPECT_EQ(Report()["levels"][0]["sweeps"], 32);
    EXPECT_EQ(Report()["levels"][2]["sweeps"], 2);
    Smooth(icosa, {"--levels", "3", "--solver", "jacobi", "--iterations", "5"});
    EXPECT_EQ(Report()["levels"][0]["sweeps"], 5);
    EXPECT_EQ(Report()["levels"][2]["sweeps"], 5);
}

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

TEST_F(CliSmooth, TheSameBytesForAnyNumberOfThreads) {
    std::string const edges = folder.Write("edges.csv", "v0,v1,width\n0,1,0.1\n");
    for (Words const& options :
         {Words{"--solver", "cg", "--precision", "double"}, Words{"--solver", "jacobi"},
          Words{"--solver", "jacobi", "--precision", "double", "--local"},
          Words{"--solver", "exact"}, Words{"--preserve-volume"}}) {
        for (std::string const threads : {"1", "2", "4"}) {
            ASSERT_EQ(Limn(Words{"smooth", spot, "-o", folder / (threads + ".ply"), "--levels", "4",
                                 "--threads", threads, "--picture", folder / (threads + ".png")} +
                           options)
                          .status,
                      0);
        }
        EXPECT_EQ(test::ReadText(folder / "1.ply"), test::ReadText(folder / "2.ply"));
        EXPECT_EQ(test::ReadText(folder / "1.ply"), test::ReadText(folder / "4.ply"));
        EXPECT_EQ(test::ReadText(folder / "1.png"), test::ReadText(folder / "4.png"));
    }
}

// In float the sweeps do what they do in double, to float's precision.
TEST_F(CliSmooth, FloatSweepsAreNearDoubleOnes) {
    Words const words{"--solver", "jacobi", "--sweeps", "2", "--levels", "3"};
    auto const precise = Smooth(spot, words);
    ASSERT_EQ(Limn(Words{"smooth", spot, "-o", folder / "float.ply"} + words).status, 0);
    auto const single = engine::ReadMesh(folder / "float.ply");
    EXPECT_LT(test::LargestDifference(precise.positions, single.positions),
              3e-6 * test::BoxDiagonal(precise.positions));
}

struct Wrong {
    Words words;
    int status;
    std::string message;
};

TEST_F(CliSmooth, WhatIsWrongIsNamed) {
    std::string const cube = WriteCube();
    auto const csv = [&](std::string const& name, std::string const& text) {
        return folder.Write(name, text);
    };
    std::string const bowtie = folder.Write(
        "bowtie.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 4 5\n");
    for (auto const& [words, status, message] : {
             Wrong{
                 {"--width", "1", "--width-factor", "1"}, 2, "--width and --width-factor exclude"},
             Wrong{{"--width", "-1"}, 2, "--width"},
             Wrong{{"--width", "nan"}, 2, "--width"},
             Wrong{{"--width", "1e300"}, 3, "times the mesh's size"},
             Wrong{{"--width-scale", "1"}, 2, "--width-scale needs --local"},
             Wrong{{"--local", "--width", "1"}, 2, "exclude"},
             Wrong{{"--solver", "exact", "--sweeps", "1"}, 2, "--sweeps means nothing"},
             Wrong{{"--solver", "jacobi", "--tolerance", "1e-3"}, 2, "--tolerance is for"},
             Wrong{{"--sweeps", "1", "--iterations", "2"}, 2, "exclude"},
             Wrong{{"--tolerance", "nan"}, 2, "--tolerance"},
             Wrong{{"--levels", "11"}, 2, "--levels"},
             Wrong{{"--graph", "--preserve-volume"}, 2, "exclude"},
             Wrong{{"--width-map", csv("a.csv", "vertex,width\n8,1\n")},
                   3,
                   "vertex 8 does not exist"},
             Wrong{{"--width-map", csv("b.csv", "vertex,width\n1,1\n1,2\n")},
                   3,
                   "b.csv:3: vertex 1 comes twice, first in line 2"},
             Wrong{{"--width-map", csv("c.csv", "vertex,width\n1,-1\n")},
                   3,
                   "c.csv:2: width -1 is negative"},
             Wrong{{"--width-edges", csv("d.csv", "v0,v1,width\n0,7,1\n")},
                   3,
                   "no edge from vertex 0 to 7"},
             Wrong{
                 {"--width-edges", csv("e.csv", "v0,v1,width\n5,7,1\n7,5,1\n")}, 3, "comes twice"},
             Wrong{{"--width-texture", folder / "none.png"}, 5, "none.png"},
             Wrong{{"--width-texture", csv("no.png", "this is no image")}, 5, "no.png"},
             Wrong{{"--width-texture", folder / "w.<UDIM>.png"}, 5, "no face lies in"},
         }) {
        ExpectError(Limn(Words{"smooth", cube, "-o", folder / "x.obj"} + words), status, message);
        EXPECT_FALSE(std::filesystem::exists(folder / "x.obj"));
    }
    ExpectError(
        Limn({"smooth", icosa, "-o", folder / "x.obj", "--width-texture", folder / "w.png"}), 3,
        "no texture coordinates");
    ExpectError(Limn({"smooth", bowtie, "-o", folder / "x.obj"}), 3, "manifold");
    ExpectError(Limn({"smooth", cube, "-o", folder / "x.stl"}), 2, ".stl");
}

// Sweeps and iterations by the million stop between two of them.
TEST_F(CliSmooth, StopsWhenInterrupted) {
    for (Words const& options :
         {Words{"--solver", "jacobi", "--iterations", "1000000"}, Words{"--tolerance", "1e-14"}}) {
        test::Process process(
            Words{LIMN_PROGRAM, "smooth", spot, "-o", folder / "x.ply", "--levels", "8"} + options);
        ::sleep(1);
        process.Send(SIGINT);
        auto const start = std::chrono::steady_clock::now();
        EXPECT_EQ(process.Wait().status, 130);
        EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
        EXPECT_FALSE(std::filesystem::exists(folder / "x.ply"));
    }
}

TEST_F(CliSmooth, DegenerateMeshesComeThroughWithNumbers) {
    struct Case {
        char const* name;
        std::string text;
    };
    std::string const faces = "f 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n";
    for (auto const& [name, text] : {
             Case{"point", "v 1 1 1\nv 1 1 1\nv 1 1 1\nv 1 1 1\n" + faces},
             Case{"line", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\n" + faces},
             Case{"flat", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.3 0.3 0\n" + faces},
             Case{"huge", "v 1e30 0 0\nv 0 1e30 0\nv 0 0 1e30\nv 0 0 0\n" + faces},
             Case{"tiny", "v 1e-30 0 0\nv 0 1e-30 0\nv 0 0 1e-30\nv 0 0 0\n" + faces},
             Case{"needle", "v 0 0 0\nv 1e-9 0 0\nv 0 1e-9 0\nv 0 0 1e6\n" + faces},
             Case{"triangle", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
             Case{"isolated", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 1 2 3\n"},
         }) {
        std::string const mesh = folder.Write(std::string(name) + ".obj", text);
        for (Words const& options :
             {Words{"--solver", "cg"}, Words{"--solver", "jacobi"}, Words{"--solver", "exact"},
              Words{"--boundary-rule", "natural"}, Words{"--preserve-volume"}, Words{"--local"}}) {
            auto const outcome =
                Limn(Words{"smooth", mesh, "-o", folder / "x.ply", "--levels", "3"} + options);
            SCOPED_TRACE(name + (" " + options.back()));
            ASSERT_EQ(outcome.status, 0) << outcome.err;
            EXPECT_TRUE(test::AreFinite(engine::ReadMesh(folder / "x.ply").positions));
        }
    }
}

class CliSmoothBake : public CliSmooth {
protected:
    engine::ExrLookup lookup;
};

// A mesh that only was refined has the same limit: no displacement, on quads and polygons as on
// triangles.
TEST_F(CliSmoothBake, ARefinedMeshIsNotDisplaced) {
    struct Case {
        std::string mesh;
        Words scheme;
    };
    for (auto const& [mesh, scheme] :
         {Case{spot, {}}, Case{WriteCube(), {}}, Case{spot, {"--scheme", "bilinear"}}}) {
        ASSERT_EQ(Limn(Words{"refine", mesh, "-o", folder / "fine.obj", "--levels", "2",
                             "--precision", "double"} +
                       scheme)
                      .status,
                  0);
        ASSERT_EQ(
            Limn(Words{"bake", mesh, "-o", folder / "d.exr", "--maps", "displacement", "--against",
                       folder / "fine.obj", "--size", "128", "--report", folder / "r.json"} +
                 scheme)
                .status,
            0);
        EXPECT_GT(Report()["texels_covered"], 1000);
        EXPECT_GT(Report()["outputs"][0]["min"], -1e-6);
        EXPECT_LT(Report()["outputs"][0]["max"], 1e-6);
    }
    ASSERT_EQ(
        Limn({"refine", spot, "-o", folder / "other.obj", "--levels", "1", "--scheme", "bilinear"})
            .status,
        0);
    std::string text = test::ReadText(folder / "other.obj");
    text.replace(text.rfind("\nf "), std::string::npos, "\n");
    ExpectError(Limn({"bake", spot, "-o", folder / "d.exr", "--maps", "displacement", "--against",
                      folder.Write("other.obj", text), "--size", "64"}),
                3, "its faces differ");
}

// The displacement towards the smoothed surface is what leads from the original limit to the
// smoothed mesh' limit: both baked as positions on their own.
TEST_F(CliSmoothBake, DisplacementLeadsToTheSmoothedSurface) {
    Smooth(spot, {"--levels", "2", "--width-factor", "0.3"}, "smooth.ply");
    for (auto const& [mesh, output] :
         {std::pair{spot, "a.exr"}, {folder / "smooth.ply", "b.exr"}}) {
        ASSERT_EQ(Limn({"bake", mesh, "-o", folder / output, "--maps", "position", "--size", "256",
                        "--coverage"})
                      .status,
                  0);
    }
    ASSERT_EQ(Limn({"bake", spot, "-o", folder / "d.exr", "--maps", "displacement", "--vector",
                    "--against", folder / "smooth.ply", "--size", "256"})
                  .status,
              0);
    int count = 0, numOther = 0;
    double largest = 0.0;
    for (int y = 0; y < 256; y += 3) {
        for (int x = 0; x < 256; x += 3) {
            auto const look = [&](char const* file, std::vector<std::string> const& channels) {
                return lookup.Look(folder / file, channels, x, y);
            };
            if (look("a.exr", {"coverage"})[0] < 1.0 || look("b.exr", {"coverage"})[0] < 1.0)
                continue;
            auto const a = look("a.exr", {"R", "G", "B"}), b = look("b.exr", {"R", "G", "B"}),
                       d = look("d.exr", {"R", "G", "B"});
            double difference = 0.0, length = 0.0;
            for (size_t c = 0; c < 3; ++c) {
                difference = test::Worse(difference, std::abs(b[c] - a[c] - d[c]));
                length = test::Worse(length, std::abs(d[c]));
            }
            ++count;
            largest = std::max(largest, length);
            // The same texture coordinates: refined by the same rule. Where charts overlap, either
            // may be seen.
            numOther += difference > 1e-4;
        }
    }
    EXPECT_GT(count, 2000);
    EXPECT_LT(numOther, count / 50);
    EXPECT_GT(largest, 0.02);
}

// Curvature motion's law on a bake of the result: a (k1 + k2) n leads back to the start surface, up
// to the constant that keeps the volume. On the side z = 1 of a cube, so that (1 - z) / n_z + c = 2
// a mean. And the width is baked as it was asked for.
TEST_F(CliSmoothBake, MeanCurvatureAndWidthOfTheResult) {
    std::string const cube = WriteCube();
    Smooth(cube, {"--levels", "6", "--width", "0.5", "--preserve-volume"}, "round.ply");
    ASSERT_EQ(Limn({"bake", folder / "round.ply", "-o", folder / "{map}.exr", "--maps",
                    "mean,position,normal,primvar:width", "--size", "384x64", "--report",
                    folder / "r.json"})
                  .status,
              0);
    json const report = Report();
    json const& width = report["outputs"].back();
    ASSERT_EQ(width["map"], "primvar:width");
    EXPECT_NEAR(width["min"].get<double>(), 0.5, 1e-6);
    EXPECT_NEAR(width["max"].get<double>(), 0.5, 1e-6);
    double const a = 0.5 * 0.5 / 2;
    auto const look = [&](char const* file, char const* channel, double x) {
        return lookup.Look(folder / file, {channel}, x, 31.5)[0];
    };
    auto const wayBack = [&](double x) {
        return (1.0 - look("position.exr", "B", x)) / look("normal.exr", "B", x);
    };
    double const middle = 95.5;  // of the second side
    for (double aside : {4.0, 8.0, 12.0, 16.0}) {
        double const curved =
            2 * a * (look("mean.exr", "Y", middle + aside) - look("mean.exr", "Y", middle));
        EXPECT_NEAR(curved, wayBack(middle + aside) - wayBack(middle), 0.05 * curved) << aside;
        EXPECT_GT(curved, 0.001);
    }
}

}  // namespace
}  // namespace limn
