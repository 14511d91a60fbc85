// SPDX-License-Identifier: Apache-2.0
//
// limn refine --space differential and limn measure from outside.

#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/io/mesh_reader.h"
#include "support/pictures.h"
#include "support/program/cli.h"
#include "support/values.h"

namespace limn {
namespace {

using namespace test::cli;

class CliDifferential : public Cli {
protected:
    std::string Mesh(std::string const& name) const {
        return test::DataPath("differential/" + name + ".obj");
    }
    Outcome Refine(std::string const& mesh, Words const& more) const {
        return Limn(Words{"refine", mesh, "-o", folder / "out.obj", "--levels", "2", "--report",
                          folder / "r.json"} +
                    more);
    }
};

// The whole way from file to file, at the accuracy of the references.
TEST_F(CliDifferential, TheReferencesAreMet) {
    struct Case {
        char const *mesh, *rule, *reference;
    };
    for (auto const& [mesh, rule, reference] :
         {Case{"icosa", "loop", "icosa_dss_loop_L2"},
          Case{"icosa", "butterfly", "icosa_dss_butterfly_L2"},
          Case{"gridholetri", "loop", "gridholetri_dss_loop_L2"},
          Case{"cube", "catmark", "cube_dss_cc_L2"}}) {
        auto const outcome = Refine(
            Mesh(mesh), {"--space", "differential", "--rule", rule, "--precision", "double"});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        auto const result = engine::ReadMesh(folder / "out.obj");
        EXPECT_LT(test::LargestDifference(
                      result.positions,
                      test::LoadPoints(fmt::format("differential/{}.obj", reference)), true),
                  1e-9)
            << reference;
        json const report = Report();
        for (char const* key : {"unknowns", "solve_seconds", "residual", "compatibility_defect",
                                "thin_plate_energy", "thin_plate_energy_area", "size_ratio"}) {
            EXPECT_TRUE(report.contains(key)) << key;
        }
        EXPECT_LT(report["residual"], 1e-10);
    }
}

TEST_F(CliDifferential, ThreadsDoNotChangeABit) {
    for (char const* threads : {"1", "2"}) {
        ASSERT_EQ(Limn({"refine", Mesh("torustri"), "-o", folder / (std::string(threads) + ".obj"),
                        "--levels", "4", "--space", "differential", "--rule", "loop", "--threads",
                        threads, "--precision", "double"})
                      .status,
                  0);
    }
    EXPECT_EQ(test::ReadText(folder / "1.obj"), test::ReadText(folder / "2.obj"));
}

TEST_F(CliDifferential, ContradictionsAreStatus2) {
    Words const differential{"--space", "differential"};
    for (auto const& [words, says] : std::vector<std::pair<Words, std::string>>{
             {{"--dirmag", "1"}, "--dirmag needs --space differential"},
             {differential + Words{"--limit"}, "--limit: the limit of --space differential"},
             {differential + Words{"--rule", "loop", "--scheme", "catmark"},
              "--rule loop contradicts --scheme catmark"},
             {differential + Words{"--rule", "loop", "--dirmag", "2", "--spatial-first", "1"},
              "--levels 2 holds no 1 levels in space and 2"},
             {differential +
                  Words{"--rule", "loop", "--laplacian", "cotangent", "--solver", "cholesky"},
              "--solver cholesky: only the combinatorial"},
             {differential + Words{"--handle", "0", "--handle", "1"}, "handles 0 and 1"},
             {{"--space", "other"}, "--space: 'other' is not one of"},
             {{"--curve", "--edit", "x.json"}, "--edit means nothing with --curve"}}) {
        ExpectError(Refine(Mesh("icosa"), words), 2, says);
        EXPECT_FALSE(std::filesystem::exists(folder / "out.obj"));
    }
}

TEST_F(CliDifferential, WhatIsNotThereIsStatus3) {
    Words const differential{"--space", "differential"};
    std::string const edit =
        folder.Write("edit.json", R"({"curvature": [{"vertex": 99, "factor": 2}]})");
    ExpectError(Refine(Mesh("icosa"), differential + Words{"--handle", "99"}), 3,
                "handle 99: there are vertices 0 to 11");
    ExpectError(Refine(Mesh("icosa"), differential + Words{"--edit", edit}), 3,
                Mesh("icosa") + ": the edit names vertex 99; there are 0 to 11");
    ExpectError(Refine(Mesh("cube"), differential + Words{"--rule", "butterfly"}), 3,
                "has 4 corners; --rule butterfly takes triangles only, --rule catmark all");
    ExpectError(Refine(Mesh("cube"), {"--rule", "loop"}), 3,
                "has 4 corners; --rule loop takes triangles only, --rule catmark all");
    ExpectError(Refine(Mesh("cube"), differential + Words{"--laplacian", "cotangent"}), 3,
                "--laplacian combinatorial takes all");
    ExpectError(Refine(Mesh("cube"), {"--curve"}), 3, "no polylines");
    ExpectError(Refine(Mesh("icosa"), differential + Words{"--edit", folder / "none.json"}), 5,
                "none.json");
}

// What of the coordinates no mesh has is no success unless it was asked for.
TEST_F(CliDifferential, UnmetCoordinatesAreStatus4) {
    Words const cotangent{"--space", "differential", "--rule", "loop", "--laplacian", "cotangent"};
    auto const missed = Refine(Mesh("torustri"), cotangent);
    std::string const error = ExpectError(missed, 4, Mesh("torustri") + ": ");
    for (char const* part :
         {"of the differential coordinates remains unmet", "more would gain little",
          "--tolerance is 0.01; nothing is written without --keep-result"})
        EXPECT_TRUE(Contains(error, part)) << error;
    EXPECT_FALSE(std::filesystem::exists(folder / "out.obj"));
    double const residual = Report()["residual"];
    EXPECT_FALSE(Report()["converged"]);
    EXPECT_TRUE(Report()["fit_stalled"]);
    EXPECT_GT(Report()["fit_steps"], 3);
    auto const accepted =
        Refine(Mesh("torustri"), cotangent + Words{"--tolerance", fmt::format("{}", 2 * residual)});
    EXPECT_EQ(accepted.status, 0) << accepted.err;
    EXPECT_TRUE(Report()["converged"]);
    EXPECT_TRUE(std::filesystem::exists(folder / "out.obj"));
}

TEST_F(CliDifferential, TheEditFileStandsInTheHelp) {
    Outcome const help = Limn({"refine", "--help"});
    for (char const* key : {"\"curvature\"", "\"factor\"", "\"rotate\"", "\"axis\"", "\"degrees\"",
                            "\"filter\"", "\"polarise\"", "\"set_curvature\"", "\"mean\"",
                            "\"set_normal\"", "\"normal\"", "\"points\""})
        EXPECT_TRUE(Contains(help.out, key)) << key;
}

// A vertex a list names is there once per kind, with what was asked for and what came of it.
TEST_F(CliDifferential, EditsAreReportedAsMeasured) {
    std::string const edit = folder.Write("edit.json", R"({"set_normal": [{"vertex": 2,
        "normal": [0, 3, 4]}], "curvature": [{"vertex": 5, "factor": 2}, {"vertex": 5, "factor": 0.5}],
        "set_curvature": [{"vertex": 4, "mean": 1.5}]})");
    auto const outcome =
        Refine(Mesh("icosa"), {"--space", "differential", "--rule", "loop", "--edit", edit});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    json const edits = Report()["edits"];
    ASSERT_EQ(edits.size(), 3u);
    EXPECT_EQ(edits[0]["vertex"], 4);
    EXPECT_EQ(edits[0]["kind"], "mean");
    EXPECT_EQ(edits[0]["asked"], 1.5);
    EXPECT_GT(edits[0]["reached"], 0.1);
    EXPECT_EQ(edits[1]["vertex"], 5);
    EXPECT_EQ(edits[2]["kind"], "normal");
    EXPECT_NEAR(edits[2]["asked"][2].get<double>(), 0.8, 1e-15);
    EXPECT_TRUE(edits[2]["reached"].is_number());
    for (char const* stage : {"coordinates", "subdivision", "reconstruction"})
        EXPECT_GE(Report()["stages"][stage], 0.0) << stage;
    EXPECT_EQ(Report()["stages"]["reconstruction"], Report()["solve_seconds"]);
}

TEST_F(CliDifferential, DeepEditsAreStatus3InOneShortLine) {
    std::string const edit = folder.Write(
        "deep.json", "{\"filter\": " + std::string(60000, '[') + std::string(60000, ']') + "}");
    std::string const error =
        ExpectError(Refine(Mesh("icosa"), {"--space", "differential", "--edit", edit}), 3,
                    "nested more than 4 deep");
    EXPECT_LT(error.size(), edit.size() + 100);
}

TEST_F(CliDifferential, CurvesGoThrough) {
    std::string const square =
        folder.Write("square.obj", "v 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nl 1 2 3 4 1\n");
    for (char const* space : {"spatial", "differential"}) {
        auto const outcome = Refine(square, {"--curve", "--space", space, "--rule", "butterfly"});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_EQ(Report()["vertices"], 16);
        EXPECT_NE(
            test::ReadText(folder / "out.obj").find("l 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 1\n"),
            std::string::npos);
    }
}

TEST_F(CliDifferential, MeasureTellsAllAndWritesWhatIsAskedFor) {
    for (char const* surface : {"limit", "mesh"}) {
        auto const outcome =
            Limn({"measure", Mesh("icosa"), "--scheme", "loop", "--surface", surface, "-o",
                  folder / surface, "--highlight", "--picture", "--view", "0,0,1"});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        json const found = ParseJson(outcome.out);
        for (char const* key : {"area", "volume", "euler_characteristic", "thin_plate_energy",
                                "thin_plate_energy_area"}) {
            EXPECT_TRUE(found[key].is_number()) << key;
        }
        for (char const* key : {"mean_curvature", "gaussian_curvature"}) {
            for (char const* part : {"min", "max", "mean", "stddev"})
                EXPECT_TRUE(found[key][part].is_number());
        }
        EXPECT_EQ(found["gauss_bonnet"][0]["audited"], true);
        EXPECT_EQ(engine::ReadMesh(folder / (std::string(surface) + ".ply")).primvars.size(), 4u);
        for (char const* ending : {".highlight.png", ".mean.png"}) {
            auto const picture = test::ReadPng(folder / (surface + std::string(ending)));
            EXPECT_GT(picture.ListColours(0, 0, picture.width, picture.height).size(), 50u);
        }
    }
    auto const open = Limn({"measure", Mesh("gridholetri"), "--surface", "mesh"});
    EXPECT_TRUE(ParseJson(open.out)["volume"].is_null());
    ExpectError(Limn({"measure", Mesh("icosa"), "--highlight"}), 2, "name their beginning with -o");
    ExpectError(
        Limn({"measure", Mesh("icosa"), "--picture", "-o", folder / "a", "--view", "0,0,0"}), 2,
        "--view 0,0,0 is no direction");
    ExpectError(Limn({"measure", folder / "none.obj"}), 5, "none.obj");
}

/// limn measure -o NAME with more words; which of both pictures it has written.
class CliMeasurePicture : public CliDifferential {
protected:
    std::vector<std::string> ListPictures(std::string const& name, Words const& more) const {
        auto const outcome =
            Limn(Words{"measure", "--surface", "mesh", "-o", folder / name} + more);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        std::vector<std::string> written;
        for (std::string const map : {"mean", "gaussian"}) {
            if (std::filesystem::exists(folder / name + "." + map + ".png")) written.push_back(map);
        }
        return written;
    }
};

TEST_F(CliMeasurePicture, IsOfTheCurvatureThatIsNamed) {
    std::string const mesh = Mesh("icosa");
    using Names = std::vector<std::string>;
    EXPECT_EQ(ListPictures("a", {mesh, "--picture"}), Names{"mean"});
    EXPECT_EQ(ListPictures("b", {mesh, "--picture", "mean"}), Names{"mean"});
    EXPECT_EQ(ListPictures("c", {mesh, "--picture", "gaussian"}), Names{"gaussian"});
    EXPECT_EQ(ListPictures("d", {"--picture=gaussian", mesh}), Names{"gaussian"});
    EXPECT_EQ(ListPictures("e", {"--picture", mesh}), Names{"mean"});  // no word of the flag's
    EXPECT_EQ(ListPictures("f", {mesh}), Names{});
    EXPECT_EQ(test::ReadText(folder / "a.mean.png"), test::ReadText(folder / "b.mean.png"));
    EXPECT_NE(test::ReadText(folder / "a.mean.png"), test::ReadText(folder / "c.gaussian.png"));
}

TEST_F(CliMeasurePicture, OtherWordsAreStatus2) {
    ExpectError(Limn({"measure", Mesh("icosa"), "-o", folder / "a", "--picture=gauss"}), 2,
                "--picture: 'gauss' is not one of mean, gaussian");
    ExpectError(Limn({"measure", Mesh("icosa"), "-o", folder / "a", "--picture", "gauss"}), 2,
                "'gauss' is one argument too many");
}

}  // namespace
}  // namespace limn
