// SPDX-License-Identifier: Apache-2.0
//
// Meshes in coordinates of a map: what is done to a mesh must not depend on where it lies, and what
// is said of a file must hold for the file.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "engine/fit/bands.h"
#include "engine/images/exr_writer.h"
#include "engine/io/mesh_reader.h"
#include "engine/io/mesh_writer.h"
#include "engine/scene/extent.h"
#include "engine/scene/refine.h"
#include "support/fit_meshes.h"
#include "support/program/cli.h"
#include "support/values.h"

namespace limn {
namespace {

using namespace test::cli;

constexpr double kShift[3] = {448266.125, 5411932.5, 312.25};

std::vector<double> Move(std::vector<double> positions) {
    for (size_t i = 0; i < positions.size(); ++i) positions[i] += kShift[i % 3];
    return positions;
}

/// Limit points of a mesh's vertices by the masks of their rings: not the road on which limn
/// certifies.
std::vector<double> FindLimits(std::string const& path) {
    engine::Job job;
    auto const model = engine::Model::Build(engine::ReadMesh(path));
    return engine::RefineUniformly(model, {.levels = 0, .toLimit = true}, job).positions;
}

class FarFromOrigin : public Cli {
protected:
    FarFromOrigin() {
        Write("torus", test::MakeTorus(8, 6));
        engine::Scene cube = test::MakeCube();
        Write("cube", cube);
        for (double& x : cube.positions) x *= 1.5;
        Write("large", cube);
    }

    /// The mesh as near/NAME.obj and far/NAME.obj, to the last digit.
    void Write(std::string const& name, engine::Scene scene) const {
        for (char const* place : {"near", "far"})
            std::filesystem::create_directories(folder / place);
        engine::WriteMesh(folder / "near/" + name + ".obj", scene, Precision::Double);
        scene.positions = Move(scene.positions);
        engine::WriteMesh(folder / "far/" + name + ".obj", scene, Precision::Double);
    }

    /// Runs a verb on a mesh of "near" or "far", and all words that name files there.
    Outcome Run(std::string const& place, Words words) const {
        for (std::string& word : words) {
            if (word.ends_with(".obj") || word.ends_with(".ply") || word.starts_with("out"))
                word = folder / place + "/" + word;
        }
        return Limn(words + Words{"--report", folder / "r.json"});
    }

    std::vector<double> Read(std::string const& path) const {
        return engine::ReadMesh(folder / path).positions;
    }

    /// \param name  of the mesh that was written, the same near and far
    void ExpectTheSameMeshElsewhere(std::string const& name) const {
        auto const near = Read("near/" + name), far = Read("far/" + name);
        EXPECT_LE(test::LargestDifference(far, Move(near)), 1e-6 * test::BoxDiagonal(near));
    }
};

// -------- meshes

struct Command {
    std::string name;
    Words words;
    std::string output = "out.obj";  ///< one of the meshes that it writes
};

void PrintTo(Command const& command, std::ostream* out) {
    *out << command.name;
}

class FarMesh : public FarFromOrigin, public testing::WithParamInterface<Command> {};

TEST_P(FarMesh, IsTheNearOneMoved) {
    auto const& [name, words, output] = GetParam();
    ASSERT_EQ(Run("near", words + Words{"--precision", "double"}).status, 0);
    Outcome const outcome = Run("far", words);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    ExpectTheSameMeshElsewhere(output);
}

TEST_P(FarMesh, IsWrittenInDoubleWithOneWord) {
    auto const& [name, words, output] = GetParam();
    Outcome const outcome = Run("far", words);
    json report = Report();
    if (report.contains("outputs")) report = report["outputs"].back();
    EXPECT_EQ(report["precision_written"], "double");
    auto const lines = Lines(outcome.err);
    auto const isWord = [](std::string const& line) {
        return Contains(line, "in double, for floats are off by up to 0.3");
    };
    EXPECT_EQ(std::ranges::count_if(lines, isWord), 1) << outcome.err;
}

TEST_P(FarMesh, NearTheOriginIsWrittenInFloatsWithoutAWord) {
    auto const& [name, words, output] = GetParam();
    Outcome const outcome = Run("near", words);
    json report = Report();
    if (report.contains("outputs")) report = report["outputs"].back();
    EXPECT_EQ(report["precision_written"], "float");
    EXPECT_FALSE(Contains(outcome.err, "in double")) << outcome.err;
}

TEST_P(FarMesh, IsWrittenInFloatsIfAskedForWithAWord) {
    auto const& [name, words, output] = GetParam();
    bool const hasTolerance = name == "fit";
    Outcome const outcome = Run("far", words + (hasTolerance ? Words{"--keep-result"} : Words{}) +
                                           Words{"--precision", "float"});
    ASSERT_EQ(outcome.status, hasTolerance ? 4 : 0) << outcome.err;
    EXPECT_TRUE(Contains(outcome.err, "--precision double keeps it all")) << outcome.err;
    auto const positions = Read("far/" + output);
    for (size_t i = 1; i < positions.size(); i += 3)
        EXPECT_EQ(std::remainder(positions[i], 0.5), 0.0) << "floats are so far apart there";
}

INSTANTIATE_TEST_SUITE_P(
    Of, FarMesh,
    testing::Values(
        Command{"refine", {"refine", "torus.obj", "-o", "out.obj"}},
        Command{"limit", {"refine", "cube.obj", "-o", "out.ply", "--limit"}, "out.ply"},
        Command{"fit", {"fit", "torus.obj", "-o", "out.obj"}},
        Command{"denoise", {"denoise", "cube.obj", "-o", "out.obj"}},
        Command{"sharpen", {"sharpen", "torus.obj", "-o", "out.ply"}, "out.ply"},
        Command{"morph", {"morph", "cube.obj", "large.obj", "-o", "out"}, "out.0010.obj"},
        Command{"smooth", {"smooth", "cube.obj", "-o", "out.obj", "--solver", "exact"}},
        Command{"jacobi", {"smooth", "torus.obj", "-o", "out.obj", "--solver", "jacobi"}},
        Command{"field", {"field", "torus.obj", "-o", "out.obj", "--harmonic", "1,0"}},
        Command{"measure", {"measure", "torus.obj", "-o", "out"}, "out.ply"}),
    [](auto const& of) { return of.param.name; });

TEST_F(FarFromOrigin, BandsAddUp) {
    ASSERT_EQ(Run("far", {"bands", "torus.obj", "-o", "out", "--count", "2"}).status, 0);
    for (auto const& output : Report()["outputs"]) EXPECT_EQ(output["precision_written"], "double");
    auto sum = Read("far/out.remainder.obj");
    for (char const* band : {"far/out.band0.obj", "far/out.band1.obj"}) {
        auto const part = Read(band);
        for (size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
    }
    EXPECT_LE(test::LargestDifference(sum, Read("far/torus.obj")), 1e-8);
}

TEST_F(FarFromOrigin, CurvesKeepTheirDigits) {
    for (char const* place : {"near/c.obj", "far/c.obj"}) {
        bool const isFar = place[0] == 'f';
        std::string text;
        for (double x : {0.0, 1.0, 2.0, 3.0}) {
            text += fmt::format("v {} {} {}\n", x + isFar * kShift[0], x * x + isFar * kShift[1],
                                isFar * kShift[2]);
        }
        folder.Write(place, text + "l 1 2 3 4\n");
    }
    for (std::string const place : {"near", "far"}) {
        ASSERT_EQ(Run(place, {"refine", "c.obj", "-o", "out.obj", "--curve"}).status, 0);
        EXPECT_EQ(Report()["precision_written"], place == "far" ? "double" : "float");
    }
    auto const near = Lines(test::ReadText(folder / "near/out.obj")),
               far = Lines(test::ReadText(folder / "far/out.obj"));
    ASSERT_EQ(near.size(), far.size());
    for (size_t i = 0; i < near.size() && near[i].starts_with("v "); ++i) {
        std::istringstream a(near[i].substr(2)), b(far[i].substr(2));
        double x = 0.0, y = 0.0;
        for (double shift : kShift) {
            a >> x, b >> y;
            EXPECT_NEAR(x + shift, y, 1e-8);
        }
    }
}

// -------- figures of a report hold for the file

TEST_F(FarFromOrigin, ACertificateIsOfTheFile) {
    for (std::string const place : {"near", "far"}) {
        for (std::string const output : {"out.obj", "out.ply"}) {
            for (Words const& more : {Words{}, Words{"--precision", "float"},
                                      Words{"--tolerance", "1e-9"}, Words{"--alpha", "0.5"}}) {
                SCOPED_TRACE(place + " " + output + " " + (more.empty() ? "" : more[1]));
                Outcome const outcome =
                    Run(place, Words{"fit", "torus.obj", "-o", output, "--keep-result"} + more);
                json const report = Report();
                auto const data = Read(place + "/torus.obj");
                auto limits = FindLimits(folder / place + "/" + output);
                limits.resize(data.size());  // with alpha the mesh is finer; its first vertices
                double worst = 0.0;
                for (size_t i = 0; i < data.size(); i += 3) {
                    worst =
                        std::max(worst, std::hypot(limits[i] - data[i], limits[i + 1] - data[i + 1],
                                                   limits[i + 2] - data[i + 2]));
                }
                double const miss = worst / test::BoxDiagonal(data);
                EXPECT_NEAR(report["certificate"]["max"], miss, 1e-9);
                double const tolerance =
                    Contains(fmt::format("{}", fmt::join(more, " ")), "1e-9") ? 1e-9 : 1e-6;
                EXPECT_EQ(outcome.status, miss <= 1.001 * tolerance ? 0 : 4) << outcome.err;
            }
        }
    }
}

TEST_F(FarFromOrigin, AFitInFloatsThatMissesIsStatus4AndNothingIsWritten) {
    Outcome const outcome =
        Run("far", {"fit", "torus.obj", "-o", "out.obj", "--precision", "float"});
    std::string const error = ExpectError(outcome, 4, "its coordinates rounded to float, misses");
    EXPECT_TRUE(Contains(error, "use --precision double")) << error;
    EXPECT_GT(Report()["certificate"]["max"], 1e-3);
    EXPECT_FALSE(std::filesystem::exists(folder / "far/out.obj"));
}

TEST_F(FarFromOrigin, ATightToleranceIsKeptByDoubles) {
    ASSERT_EQ(Run("near", {"fit", "torus.obj", "-o", "out.obj", "--tolerance", "1e-10"}).status, 0);
    EXPECT_EQ(Report()["precision_written"], "double");
    EXPECT_LE(test::LargestDifference(FindLimits(folder / "near/out.obj"), Read("near/torus.obj")),
              1e-10 * test::BoxDiagonal(Read("near/torus.obj")));
}

TEST_F(FarFromOrigin, BoxesAreThoseOfTheFiles) {
    auto const expectBox = [&](json const& box, std::string const& path) {
        auto const extent = engine::FindExtent(Read(path));
        for (size_t c = 0; c < 3; ++c) {
            EXPECT_EQ(box[0][c], extent.low[c]) << path;
            EXPECT_EQ(box[1][c], extent.high[c]) << path;
        }
    };
    for (std::string const place : {"near", "far"}) {
        for (std::string const output : {"out.obj", "out.ply"}) {
            for (std::string const precision : {"float", "double"}) {
                Run(place, {"denoise", "torus.obj", "-o", output, "--precision", precision});
                expectBox(Report()["after"]["bounding_box"], place + "/" + output);
            }
        }
        Run(place, {"morph", "cube.obj", "large.obj", "-o", "out", "--steps", "2"});
        expectBox(Report()["outputs"][0]["bounding_box"], place + "/out.0001.obj");
        expectBox(Report()["after"]["bounding_box"], place + "/out.0002.obj");
        Run(place, {"bands", "torus.obj", "-o", "out", "--count", "1"});
        expectBox(Report()["outputs"][1]["bounding_box"], place + "/out.remainder.obj");
    }
}

TEST_F(FarFromOrigin, VolumesAreThoseOfTheFiles) {
    Write("sphere", test::MakeIcosphere(1));
    for (std::string const place : {"near", "far"}) {
        ASSERT_EQ(Run(place, {"smooth", "sphere.obj", "-o", "out.obj", "--preserve-volume"}).status,
                  0);
        double const told = Report()["volumes"][0]["end"];
        auto const model = engine::Model::Build(engine::ReadMesh(folder / place + "/out.obj"));
        double const volume = engine::MeasureExtent(model, model.GetPositions()).volume.value();
        EXPECT_NEAR(told, volume, 1e-14) << place;
        bool const isExact = told == Report()["volumes"][0]["start"].get<double>();
        EXPECT_FALSE(place == "near" && isExact) << "floats cannot";
    }
}

TEST_F(FarFromOrigin, EnergiesAreThoseOfTheFiles) {
    Words const refine{"refine", "torus.obj", "-o", "out.obj", "--space", "differential"};
    ASSERT_EQ(Run("near", refine).status, 0);
    double const told = Report()["thin_plate_energy"];
    ASSERT_EQ(Run("near", {"measure", "out.obj", "--surface", "mesh"}).status, 0);
    EXPECT_NEAR(told, Report()["thin_plate_energy"], 1e-14 * told);
    ASSERT_EQ(Run("near", refine + Words{"--precision", "double"}).status, 0);
    EXPECT_NE(told, Report()["thin_plate_energy"]) << "which the same mesh in doubles has not";
}

// -------- maps

TEST_F(FarFromOrigin, AnOriginStandsInHeaderAndReport) {
    Words const bake{
        "bake",   folder / "far/torus.obj", "-o",       folder / "{map}.exr", "--size", "16",
        "--maps", "position,normal",        "--report", folder / "r.json"};
    ASSERT_EQ(Limn(bake + Words{"--origin", "auto"}).status, 0);
    json const report = Report();
    std::vector<double> const origin = report["origin"];
    EXPECT_EQ(report["outputs"][0]["origin"], report["origin"]);
    EXPECT_FALSE(report["outputs"][1].contains("origin"));
    auto const extent = engine::FindExtent(Read("far/torus.obj"));
    for (size_t c = 0; c < 3; ++c) {
        EXPECT_EQ(origin[c], std::round(origin[c]));
        EXPECT_NEAR(origin[c], 0.5 * (extent.low[c] + extent.high[c]), extent.GetDiagonal());
    }
    std::pair<std::string, std::string> const header{
        "limn:origin", fmt::format("{},{},{}", origin[0], origin[1], origin[2])};
    auto const position = engine::ReadExrAttributes(folder / "position.exr", "limn:"),
               normal = engine::ReadExrAttributes(folder / "normal.exr", "limn:origin");
    EXPECT_EQ(std::ranges::count(position, header), 1);
    EXPECT_TRUE(normal.empty());
    EXPECT_TRUE(report["warnings"].empty());
}

TEST_F(FarFromOrigin, AnOriginIsThreeNumbersOrAutoAndForPositions) {
    auto const refuse = [&](std::string const& maps, std::string const& origin,
                            std::string const& says) {
        ExpectError(Bake(folder / "far/torus.obj", "a.exr", {"--maps", maps, "--origin", origin}),
                    2, says);
    };
    for (char const* origin : {"1,2", "1,2,3,4", "1,2,", "1,2,3,", "here", ""})
        refuse("position", origin, "--origin");
    refuse("normal", "auto", "--origin has no effect on normal; it is for position");
}

// -------- tables

TEST_F(FarFromOrigin, TablesHaveTheDigitsThatTheMeshNeeds) {
    std::string const places = folder.Write("p.csv", "face,s,t\n0,0.3,0.6\n");
    auto const evaluate = [&](std::string const& place, Words const& more = {}) {
        Outcome const outcome =
            Run(place, Words{"eval", "torus.obj", "--at", places, "-o", "out.csv"} + more);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        std::istringstream row(Lines(test::ReadText(folder / place + "/out.csv")).at(1));
        std::vector<double> fields;
        for (std::string field; std::getline(row, field, ',');) fields.push_back(std::stod(field));
        return fields;
    };
    auto const near = evaluate("near", {"--precision", "double"}), far = evaluate("far");
    EXPECT_EQ(Report()["precision_written"], "double");
    for (size_t c = 3; c < 6; ++c) EXPECT_NEAR(far.at(c), near.at(c) + kShift[c - 3], 1e-8);
    for (size_t c = 6; c < 16; ++c) EXPECT_NEAR(far.at(c), near.at(c), 1e-7);
    evaluate("near");
    EXPECT_EQ(Report()["precision_written"], "float");
    evaluate("far", {"--precision", "float"});
    EXPECT_TRUE(Contains(Report()["warnings"].at(0), "coordinates of 9 digits are 0.01 apart"));
}

}  // namespace
}  // namespace limn
