// SPDX-License-Identifier: Apache-2.0
//
// limn smooth from outside.

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "engine/io/mesh_reader.h"
#include "engine/io/mesh_writer.h"
#include "support/fit_meshes.h"
#include "support/program/cli_smooth.h"
#include "support/values.h"

namespace limn {
namespace {

using namespace test::cli;

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

TEST_F(CliSmooth, TheSameBytesForAnyNumberOfThreads) {
    std::string const edges = folder.Write("edges.csv", "v0,v1,width\n5,13,0.1\n");
    for (Words const& options :
         {Words{"--solver", "cg", "--precision", "double"}, Words{"--solver", "jacobi"},
          Words{"--solver", "jacobi", "--precision", "double", "--local"},
          Words{"--solver", "exact"}, Words{"--preserve-volume"}, Words{"--width-edges", edges}}) {
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
        EXPECT_EQ(process.Wait().status, 130);
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

}  // namespace
}  // namespace limn
