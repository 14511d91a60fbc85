// SPDX-License-Identifier: Apache-2.0
//
// limn field, and the map field of limn bake, from outside.

#include <cmath>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "engine/images/exr_lookup.h"
#include "engine/io/edge_values.h"
#include "engine/io/mesh_reader.h"
#include "engine/io/number_table.h"
#include "far_ext/forms/form_operators.h"
#include "support/pictures.h"
#include "support/program/cli.h"
#include "support/refined.h"

namespace limn {
namespace {

using namespace test::cli;
using Vector = Eigen::Vector3d;

class CliField : public Cli {
protected:
    std::string spot = test::ScenePath("spot/spot.obj"),
                cube = test::DataPath("golden_surface/cube.obj"),
                grid = test::DataPath("golden_surface/gridholetri.obj"),
                torus = test::DataPath("golden_surface/torustri.obj");

    /// d0 of the coordinate y, as a file.
    std::string WriteGradientOfY(std::string const& mesh) const {
        auto const scene = engine::ReadMesh(mesh);
        auto const refiner = test::MakeRefiner(scene, 0);
        auto const level = refiner->GetLevel(0);
        std::string text = "v0,v1,value\n";
        for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
            auto const ends = level.GetEdgeVertices(edge);
            text += fmt::format("{},{},{}\n", ends[0], ends[1],
                                scene.positions[3 * static_cast<size_t>(ends[1]) + 1] -
                                    scene.positions[3 * static_cast<size_t>(ends[0]) + 1]);
        }
        return folder.Write("y.edges.csv", text);
    }
};

TEST_F(CliField, LevelsThatAreTypedAreKeptOrRefused) {
    Words const typed{"--source", "0", "--sink", "3", "--levels", "0"};
    std::string const triangles = Shape("catmark_pyramid"), quads = Shape("catmark_cube");
    ExpectError(Limn(Words{"field", triangles, "-o", folder / "f.obj"} + typed), 2,
                "--levels 0: not all faces are quads");
    EXPECT_EQ(Limn(Words{"field", triangles, "-o", folder / "f.faces.csv"} + typed).status, 0);
    EXPECT_EQ(Limn(Words{"field", quads, "-o", folder / "f.obj"} + typed).status, 0);
}

TEST_F(CliField, ReportTellsWhatTheFieldIsMadeOf) {
    ASSERT_EQ(
        Limn({"field", spot, "-o", folder / "f.obj", "--levels", "1", "--source", "0", "--sink",
              "100", "--vortex", "40:2", "--vortex", "150:-2", "--report", folder / "r.json"})
            .status,
        0);
    json const report = Report();
    EXPECT_EQ(report["sum_of_indices"], 2.0);
    EXPECT_EQ(report["euler_characteristic"], 2);
    EXPECT_LT(report["commutation_d0"], 1e-14);
    EXPECT_LT(report["commutation_d1"], 1e-14);
    EXPECT_LT(report["max_curl_of_gradient"], 1e-12);
    EXPECT_LT(report["max_divergence_of_vortex_part"], 1e-12);
    EXPECT_GT(report["parts"]["gradient"], 0.1);
    EXPECT_GT(report["parts"]["vortex"], 0.1);
    EXPECT_LT(report["parts"]["harmonic"], 1e-10);
    EXPECT_EQ(report["generators"], 0);
    EXPECT_FALSE(report["singularities"].empty());
    // A refined mesh with limit normals, and a tangent vector per vertex.
    auto const fine = engine::ReadMesh(folder / "f.obj");
    EXPECT_TRUE(Contains(test::ReadText(folder / "f.obj"), "vn "));
    auto const table =
        engine::ReadNumberTable(folder / "f.vectors.csv", {{"vertex", "x", "y", "z"}});
    EXPECT_EQ(table.GetNumRows(), static_cast<size_t>(fine.cage.numVertices));
}

TEST_F(CliField, VectorsAreTheProjectedAxisForTheGradientOfACoordinate) {
    ASSERT_EQ(Limn({"field", spot, "-o", folder / "f.obj", "--levels", "2", "--edges",
                    WriteGradientOfY(spot), "--precision", "double"})
                  .status,
              0);
    auto const table =
        engine::ReadNumberTable(folder / "f.vectors.csv", {{"vertex", "x", "y", "z"}});
    auto const lines = Lines(test::ReadText(folder / "f.obj"));
    size_t row = 0;
    for (std::string const& line : lines) {
        Vector normal;
        if (std::sscanf(line.c_str(), "vn %lf %lf %lf", &normal[0], &normal[1], &normal[2]) != 3)
            continue;
        Vector const vector(table.Get(row, 1), table.Get(row, 2), table.Get(row, 3));
        ASSERT_LT((vector - (Vector::UnitY() - normal.y() * normal)).norm(), 1e-9) << row;
        ++row;
    }
    EXPECT_EQ(row, table.GetNumRows());
}

TEST_F(CliField, EdgesComeBackAsTheyWere) {
    std::string const edges = WriteGradientOfY(spot);
    ASSERT_EQ(Limn({"field", spot, "-o", folder / "again.edges.csv", "--edges", edges}).status, 0);
    auto const scene = engine::ReadMesh(spot);
    auto const refiner = test::MakeRefiner(scene, 0);
    EXPECT_EQ(engine::ReadEdgeValues(edges, refiner->GetLevel(0)),
              engine::ReadEdgeValues(folder / "again.edges.csv", refiner->GetLevel(0)));
}

TEST_F(CliField, HarmonicAndMatchedFields) {
    ASSERT_EQ(Limn({"field", torus, "--scheme", "loop", "-o", folder / "f.faces.csv", "--harmonic",
                    "1,0.5", "--report", folder / "r.json"})
                  .status,
              0);
    EXPECT_EQ(Report()["generators"], 2);
    EXPECT_LT(
        Report()["parts"]["gradient"].get<double>() + Report()["parts"]["vortex"].get<double>(),
        1e-9);
    EXPECT_TRUE(Report()["sum_of_indices"] == 0.0);
    // The vectors of that field, matched, are that field.
    ASSERT_EQ(Limn({"field", torus, "--scheme", "loop", "-o", folder / "g.faces.csv", "--match",
                    folder / "f.faces.csv"})
                  .status,
              0);
    auto const a = engine::ReadNumberTable(folder / "f.faces.csv", {{"face", "x", "y", "z"}}),
               b = engine::ReadNumberTable(folder / "g.faces.csv", {{"face", "x", "y", "z"}});
    EXPECT_EQ(a.GetNumRows(), 192u);
    ASSERT_EQ(a.values.size(), b.values.size());
    for (size_t i = 0; i < a.values.size(); ++i) EXPECT_NEAR(a.values[i], b.values[i], 2e-3);
}

// The mesh file is rounded to float, and with it the tangents that the vectors lie along.
TEST_F(CliField, VectorsOfADesignedFieldGiveItBack) {
    ASSERT_EQ(
        Limn({"field", spot, "-o", folder / "a.obj", "--levels", "1", "--source", "0", "--sink",
              "100", "--vortex", "40:2", "--vortex", "150:-2", "--report", folder / "r.json"})
            .status,
        0);
    json const designed = Report();
    EXPECT_EQ(designed["singularities"].size(), 6u);
    ASSERT_EQ(Limn({"field", folder / "a.obj", "-o", folder / "b.obj", "--levels", "0", "--match",
                    folder / "a.vectors.csv", "--report", folder / "r.json"})
                  .status,
              0);
    EXPECT_EQ(Report()["singularities"], designed["singularities"]);
    auto const read = [&](char const* name) {
        auto const table = engine::ReadNumberTable(folder / name, {{"vertex", "x", "y", "z"}});
        Eigen::MatrixX3d vectors(table.GetNumRows(), 3);
        for (size_t row = 0; row < table.GetNumRows(); ++row)
            vectors.row(row) << table.Get(row, 1), table.Get(row, 2), table.Get(row, 3);
        return vectors;
    };
    Eigen::MatrixX3d const wanted = read("a.vectors.csv"), found = read("b.vectors.csv");
    ASSERT_EQ(found.rows(), wanted.rows());
    EXPECT_LT((found - wanted).norm(), 1e-6 * wanted.norm());
}

TEST_F(CliField, TheSameBytesForAnyNumberOfThreads) {
    for (char const* threads : {"1", "4"}) {
        ASSERT_EQ(Limn({"field", spot, "-o", folder / (std::string(threads) + ".obj"), "--levels",
                        "2", "--source", "0", "--sink", "9", "--threads", threads})
                      .status,
                  0);
    }
    EXPECT_EQ(test::ReadText(folder / "1.vectors.csv"), test::ReadText(folder / "4.vectors.csv"));
    EXPECT_EQ(test::ReadText(folder / "1.obj"), test::ReadText(folder / "4.obj"));
}

TEST_F(CliField, WhatIsWrongIsNamed) {
    auto const refuse = [&](Words const& words, int status, std::string const& part) {
        ExpectError(Limn(Words{"field"} + words + Words{"-o", folder / "f.obj"}), status, part);
        EXPECT_FALSE(std::filesystem::exists(folder / "f.obj"));
    };
    refuse({cube}, 2, "at least one of");
    refuse({cube, "--source", "8", "--sink", "0"}, 3,
           "a source or sink: vertex 8 does not exist; there are 0 to 7");
    refuse({cube, "--vortex", "-1"}, 3, "a vortex: face -1 does not exist");
    refuse({cube, "--source", "x"}, 2, "--source: 'x' is no whole number");
    refuse({cube, "--source", "1:nan"}, 2, "'nan' is no number");
    refuse({cube, "--source", "1:2", "--sink", "3"}, 3, "add up to 1, not 0");
    refuse({cube, "--vortex", "1"}, 3, "--balance");
    refuse({cube, "--harmonic", "1"}, 3, "1 coefficients; the surface has 0 generators");
    refuse({cube, "--edges", folder.Write("e.csv", "v0,v1,value\n0,6,1\n")}, 3,
           "e.csv:2: there is no edge from vertex 0 to 6");
    refuse({cube, "--edges", folder.Write("e.csv", "v0,v1,value\n0,1,1\n1,0,1\n")}, 3,
           "comes twice, first in line 2");
    refuse({cube, "--edges", folder.Write("e.csv", "v0,v1,value\n0,1,nan\n")}, 3,
           "e.csv:2: 'nan' in column value is no number");
    refuse({cube, "--edges", folder.Write("e.csv", "v0,v1,value\n0,1,1e999\n")}, 3, "e.csv:2");
    refuse({cube, "--edges", folder.Write("e.csv", "a,b\n")}, 3,
           "e.csv:1: the header needs the columns v0,v1,value");
    refuse({cube, "--match", folder.Write("m.csv", "face,x,y,z\n6,1,0,0\n")}, 3,
           "m.csv:2: face 6 does not exist");
    refuse({cube, "--edges", folder / "missing.csv"}, 5, "missing.csv");
    EXPECT_EQ(Limn({"field", cube, "-o", folder / "b.obj", "--vortex", "1", "--balance"}).status,
              0);
    EXPECT_EQ(Limn({"field", grid, "--scheme", "loop", "-o", folder / "n.obj", "--source", "1",
                    "--at-boundary", "normal"})
                  .status,
              0);
    ExpectError(Limn({"field", cube, "-o", folder / "f.txt", "--vortex", "1"}), 2,
                "a field is written as .obj or .ply");
}

// What is over is taken off all faces of the component alike.
TEST_F(CliField, BalanceSpreadsTheDefectEvenly) {
    ASSERT_EQ(
        Limn({"field", cube, "-o", folder / "b.edges.csv", "--vortex", "1:3", "--balance"}).status,
        0);
    auto const refiner = test::MakeRefiner(engine::ReadMesh(cube), 0);
    auto const level = refiner->GetLevel(0);
    auto const curl =
        far_ext::BuildD1(level).Apply(engine::ReadEdgeValues(folder / "b.edges.csv", level));
    for (size_t face = 0; face < curl.size(); ++face)
        EXPECT_NEAR(curl[face], face == 1 ? 2.5 : -0.5, 1e-12);
}

// spot has faces that are not quads: arrows would need another level than the edges that are
// written.
TEST_F(CliField, APictureDoesNotChangeTheOutput) {
    Words const field{"field", spot, "--source", "0", "--sink", "9", "--picture", folder / "p.png"};
    auto const run = [&](Words const& more) { return Limn(field + more); };
    ExpectError(run({"-o", folder / "a.edges.csv"}), 2, "--levels 1");
    EXPECT_TRUE(folder.List().empty());
    ASSERT_EQ(run({"-o", folder / "a.edges.csv", "--levels", "1"}).status, 0);
    ASSERT_EQ(Limn({"field", spot, "--source", "0", "--sink", "9", "-o", folder / "b.edges.csv",
                    "--levels", "1"})
                  .status,
              0);
    EXPECT_EQ(test::ReadText(folder / "a.edges.csv"), test::ReadText(folder / "b.edges.csv"));
    auto const picture = test::ReadPng(folder / "p.png");
    EXPECT_GT(picture.ListColours(0, 0, picture.width, picture.height).size(), 50u);
}

// A field from the outer boundary straight to the inner one vanishes nowhere.
TEST_F(CliField, AFieldAcrossBoundariesIsNotSingularThere) {
    ASSERT_EQ(Limn({"field", grid, "--scheme", "loop", "--at-boundary", "normal", "--harmonic", "1",
                    "--levels", "1", "-o", folder / "x.obj", "--report", folder / "r.json",
                    "--picture", folder / "x.png"})
                  .status,
              0);
    EXPECT_TRUE(Report()["singularities"].empty());
    EXPECT_EQ(Report()["sum_of_indices"], 0.0);
    auto const picture = test::ReadPng(folder / "x.png");
    EXPECT_GT(picture.ListColours(0, 0, picture.width, picture.height).size(), 20u);
}

class CliFieldBake : public CliField {
protected:
    std::vector<double> Look(std::string const& file, std::vector<std::string> const& channels,
                             int x, int y) {
        return _lookup.Look(folder / file, channels, x, y);
    }

private:
    engine::ExrLookup _lookup;
};

TEST_F(CliFieldBake, ObjectVectorsAreTheProjectedAxisAtEveryTexel) {
    ASSERT_EQ(Limn({"bake", spot, "-o", folder / "{map}.exr", "--maps", "field,normal", "--field",
                    WriteGradientOfY(spot), "--size", "256", "--coverage", "--padding", "0"})
                  .status,
              0);
    int count = 0, numOff = 0;
    double worst = 0.0;
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            auto const f = Look("field.exr", {"R", "G", "B", "coverage"}, x, y),
                       n = Look("normal.exr", {"R", "G", "B"}, x, y);
            if (f[3] < 1.0) continue;
            ++count;
            Vector const normal(n[0], n[1], n[2]);
            double const deviation =
                (Vector(f[0], f[1], f[2]) - (Vector::UnitY() - normal.y() * normal)).norm();
            worst = test::Worse(worst, deviation);
            numOff += deviation > 1e-5;
        }
    }
    EXPECT_GT(count, 10000);
    // Exact but for the texels that touch an extraordinary vertex.
    EXPECT_LT(numOff, count / 50);
    EXPECT_LT(worst, 0.1);
}

// The flow in texture coordinates, carried back by differences of positions, is the vector.
TEST_F(CliFieldBake, FlowIsTheVectorInTextureCoordinates) {
    std::string const edges = WriteGradientOfY(spot);
    Words const rest{"--field", edges, "--size", "512", "--coverage", "--padding", "0", "--quiet"};
    auto const bake = [&](Words const& words) { return Limn(words + rest).status; };
    ASSERT_EQ(bake({"bake", spot, "-o", folder / "{map}.exr", "--maps", "field,position"}), 0);
    ASSERT_EQ(bake({"bake", spot, "-o", folder / "uv.exr", "--maps", "field", "--space", "uv"}), 0);
    ASSERT_EQ(bake({"bake", spot, "-o", folder / "unit.exr", "--maps", "field", "--space", "uv",
                    "--normalize", "--encode", "0.5,0.5"}),
              0);
    int count = 0, numFar = 0;
    for (int y = 1; y < 511; y += 6) {
        for (int x = 1; x < 511; x += 6) {
            auto const isCovered = [&](int dx, int dy) {
                return Look("position.exr", {"coverage"}, x + dx, y + dy)[0] >= 1.0;
            };
            if (!isCovered(0, 0) || !isCovered(1, 0) || !isCovered(-1, 0) || !isCovered(0, 1) ||
                !isCovered(0, -1))
                continue;
            auto const at = [&](int dx, int dy) {
                auto const p = Look("position.exr", {"R", "G", "B"}, x + dx, y + dy);
                return Vector(p[0], p[1], p[2]);
            };
            Vector const du = 256.0 * (at(1, 0) - at(-1, 0)),
                         dv = 256.0 * (at(0, -1) - at(0, 1));  // v upwards
            auto const flow = Look("uv.exr", {"R", "G"}, x, y),
                       v = Look("field.exr", {"R", "G", "B"}, x, y),
                       unit = Look("unit.exr", {"R", "G"}, x, y);
            ++count;
            numFar += (flow[0] * du + flow[1] * dv - Vector(v[0], v[1], v[2])).norm() > 0.03;
            Eigen::Vector2d const direction(2 * unit[0] - 1, 2 * unit[1] - 1);
            EXPECT_NEAR(direction.norm(), 1.0, 1e-5);
            EXPECT_GT(direction.dot(Eigen::Vector2d(flow[0], flow[1]).normalized()), 0.999);
        }
    }
    EXPECT_GT(count, 1000);
    EXPECT_LT(numFar, count / 100) << "differences across neighbouring charts";
}

TEST_F(CliFieldBake, WhatIsWrongIsNamed) {
    std::string const edges = WriteGradientOfY(spot);
    ExpectError(Limn({"bake", spot, "-o", folder / "f.exr", "--maps", "field"}), 2, "--field");
    ExpectError(Limn({"bake", spot, "-o", folder / "f.exr", "--maps", "field", "--field", edges,
                      "--space", "tangent"}),
                2, "object or uv");
    ExpectError(Limn({"bake", spot, "-o", folder / "f.exr", "--maps", "normal", "--space", "uv"}),
                2, "--space has no effect on normal");
    std::string const bad = folder.Write("bad.csv", "v0,v1,value\n0,1000,1\n");
    ExpectError(Limn({"bake", spot, "-o", folder / "f.exr", "--maps", "field", "--field", bad}), 3,
                "vertex 1000 does not exist");
}

TEST_F(CliFieldBake, TheSameBytesForAnyNumberOfThreads) {
    for (std::string const threads : {"1", "4"}) {
        std::filesystem::create_directory(folder / threads);
        ASSERT_EQ(Limn({"bake", spot, "-o", folder / (threads + "/f.exr"), "--maps", "field",
                        "--field", WriteGradientOfY(spot), "--size", "128", "--space", "uv",
                        "--normalize", "--samples", "2", "--preview", "--threads", threads})
                      .status,
                  0);
    }
    EXPECT_EQ(test::ReadText(folder / "1/f.exr"), test::ReadText(folder / "4/f.exr"));
    EXPECT_EQ(test::ReadText(folder / "1/f.png"), test::ReadText(folder / "4/f.png"));
}

TEST_F(CliFieldBake, AnotherFieldIsNotUpToDate) {
    Words const words{"bake",
                      spot,
                      "-o",
                      folder / "f.exr",
                      "--maps",
                      "field",
                      "--field",
                      WriteGradientOfY(spot),
                      "--size",
                      "64",
                      "--skip-existing",
                      "--report",
                      folder / "r.json"};
    ASSERT_EQ(Limn(words).status, 0);
    ASSERT_EQ(Limn(words).status, 0);
    EXPECT_TRUE(Report()["outputs"][0]["skipped"]);
    std::string text = test::ReadText(folder / "y.edges.csv");
    folder.Write("y.edges.csv", text.substr(0, text.rfind('\n', text.size() - 2) + 1));
    ASSERT_EQ(Limn(words).status, 0);
    EXPECT_FALSE(Report()["outputs"][0]["skipped"]);
}

// Grey streaks along the flow: from texel to texel along it they change less than across.
TEST_F(CliFieldBake, PreviewShowsStreaksAlongTheFlow) {
    ASSERT_EQ(Limn({"bake", spot, "-o", folder / "f.exr", "--maps", "field", "--field",
                    WriteGradientOfY(spot), "--size", "128", "--space", "uv", "--preview",
                    "--coverage", "--padding", "0"})
                  .status,
              0);
    auto const picture = test::ReadPng(folder / "f.png");
    ASSERT_EQ(picture.width, 128);
    ASSERT_EQ(picture.height, 128);
    auto const isCovered = [&](int x, int y) {
        return Look("f.exr", {"coverage"}, x, y)[0] >= 1.0;
    };
    double along = 0.0, across = 0.0;
    int count = 0;
    for (int y = 1; y < 127; ++y) {
        for (int x = 1; x < 127; ++x) {
            auto const [r, g, b] = picture.At(x, y);
            EXPECT_TRUE(r == g && g == b);
            if (Look("f.exr", {"coverage"}, x, y)[0] > 0.0) {
                EXPECT_GT(r, 0) << x << " " << y;  // previews are padded beyond
            }
            auto const flow = Look("f.exr", {"R", "G"}, x, y);
            double const length = std::hypot(flow[0], flow[1]);
            int const dx = static_cast<int>(std::lround(flow[0] / length)),
                      dy = static_cast<int>(std::lround(-flow[1] / length));  // v upwards
            if (!isCovered(x, y) || !isCovered(x + dx, y + dy) || !isCovered(x - dy, y + dx))
                continue;
            auto const difference = [&](int i, int j) {
                return std::pow(picture.At(x + i, y + j)[0] - r, 2);
            };
            along += difference(dx, dy);
            across += difference(-dy, dx);
            ++count;
        }
    }
    EXPECT_GT(count, 1000);
    EXPECT_LT(along, 0.5 * across);
}

}  // namespace
}  // namespace limn
