// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/io/mesh_reader.h"
#include "support/program.h"
#include "support/refined.h"

namespace limn {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

class DifferentialCli : public testing::Test {
protected:
    test::Outcome Limn(Words words) const {
        words.insert(words.begin(), LIMN_PROGRAM);
        return test::Process(words).Wait();
    }
    std::string Mesh(std::string const& name) const {
        return test::DataPath("differential/" + name + ".obj");
    }
    json Report() const { return json::parse(test::ReadText(folder / "report.json")); }

    test::Outcome Refine(std::string const& mesh, Words const& more) const {
        Words words{"refine",   mesh, "-o",       folder / "out.obj",
                    "--levels", "2",  "--report", folder / "report.json"};
        words.insert(words.end(), more.begin(), more.end());
        return Limn(words);
    }

    test::TemporaryFolder folder;
};

// The whole way from file to file, at the accuracy of the references.
TEST_F(DifferentialCli, TheReferencesAreMet) {
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
        EXPECT_LT(test::LargestDifference(result.positions, test::LoadPoints(reference), true),
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

TEST_F(DifferentialCli, ThreadsDoNotChangeABit) {
    for (char const* threads : {"1", "2"}) {
        ASSERT_EQ(Limn({"refine", Mesh("torustri"), "-o", folder / (std::string(threads) + ".obj"),
                        "--levels", "4", "--space", "differential", "--rule", "loop", "--threads",
                        threads, "--precision", "double"})
                      .status,
                  0);
    }
    EXPECT_EQ(test::ReadText(folder / "1.obj"), test::ReadText(folder / "2.obj"));
}

TEST_F(DifferentialCli, ContradictionsAreStatus2) {
    for (Words const& words :
         {Words{"--dirmag", "1"}, Words{"--space", "differential", "--limit"},
          Words{"--space", "differential", "--rule", "loop", "--scheme", "catmark"},
          Words{"--space", "differential", "--rule", "loop", "--dirmag", "2", "--spatial-first",
                "1"},
          Words{"--space", "differential", "--rule", "loop", "--laplacian", "cotangent", "--solver",
                "cholesky"},
          Words{"--space", "differential", "--handle", "0", "--handle", "1"},
          Words{"--space", "other"}, Words{"--curve", "--edit", "x.json"}}) {
        auto const outcome = Refine(Mesh("icosa"), words);
        EXPECT_EQ(outcome.status, 2) << outcome.err;
        EXPECT_TRUE(outcome.err.starts_with("limn: error: ")) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "out.obj"));
    }
}

TEST_F(DifferentialCli, WhatIsNotThereIsStatus3) {
    std::string const edit =
        folder.Write("edit.json", R"({"curvature": [{"vertex": 99, "factor": 2}]})");
    for (Words const& words : {Words{"--space", "differential", "--handle", "99"},
                               Words{"--space", "differential", "--edit", edit}}) {
        EXPECT_EQ(Refine(Mesh("icosa"), words).status, 3);
    }
    EXPECT_EQ(Refine(Mesh("cube"), {"--space", "differential", "--rule", "butterfly"}).status, 3);
    EXPECT_EQ(Refine(Mesh("cube"), {"--rule", "loop"}).status, 3);
    EXPECT_EQ(Refine(Mesh("cube"), {"--curve"}).status, 3);
    EXPECT_EQ(
        Refine(Mesh("icosa"), {"--space", "differential", "--edit", folder / "none.json"}).status,
        5);
}

TEST_F(DifferentialCli, CurvesGoThrough) {
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

TEST_F(DifferentialCli, MeasureTellsAllAndWritesWhatIsAskedFor) {
    for (char const* surface : {"limit", "mesh"}) {
        auto const outcome =
            Limn({"measure", Mesh("icosa"), "--scheme", "loop", "--surface", surface, "-o",
                  folder / surface, "--highlight", "--picture", "--view", "0,0,1"});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        json const found = json::parse(outcome.out);
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
            EXPECT_TRUE(
                test::ReadText(folder / (surface + std::string(ending))).starts_with("\x89PNG"));
        }
    }
    auto const open = Limn({"measure", Mesh("gridholetri"), "--surface", "mesh"});
    EXPECT_TRUE(json::parse(open.out)["volume"].is_null());
    EXPECT_EQ(Limn({"measure", Mesh("icosa"), "--highlight"}).status, 2);
    EXPECT_EQ(
        Limn({"measure", Mesh("icosa"), "--picture", "-o", folder / "a", "--view", "0,0,0"}).status,
        2);
    EXPECT_EQ(Limn({"measure", Mesh("icosa"), "--report", "-"}).status, 2);
    EXPECT_EQ(Limn({"measure", folder / "none.obj"}).status, 5);
}

}  // namespace
}  // namespace limn
