// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>

#include "engine/io/mesh_reader.h"
#include "support/program/cli.h"
#include "support/values.h"

namespace limn {
namespace {

using namespace test::cli;

class CliFit : public Cli {
protected:
    std::string cube = test::DataPath("golden_surface/cube.obj"),
                icosa = test::DataPath("golden_surface/icosa.obj"),
                grid = test::DataPath("golden_surface/gridholetri.obj");

    std::string MakePerturbedCube() const {
        std::string text = test::ReadText(cube);
        text.replace(text.find("v "), text.find('\n', text.find("v ")) - text.find("v "),
                     "v -0.9 -0.8 -1");
        return folder.Write("perturbed.obj", text);
    }
};

TEST_F(CliFit, ReportHasItsKeysAndTheOutputIsTheFit) {
    ASSERT_EQ(Limn({"fit", icosa, "-o", folder / "a.obj", "--tolerance", "1e-12", "--precision",
                    "double", "--report", folder / "r.json"})
                  .status,
              0);
    json const report = Report();
    EXPECT_EQ(report["method"], "chebyshev");
    EXPECT_TRUE(report["converged"]);
    EXPECT_GT(report["iterations"], 3);
    EXPECT_EQ(report["residual_history"].size(), report["iterations"]);
    EXPECT_LE(report["residual"], 1e-12);
    EXPECT_LE(report["certificate"]["max"], 1.1e-12);
    EXPECT_LE(report["certificate"]["rms"], report["certificate"]["max"]);
    EXPECT_GT(report["lambda_min"], 0.1);
    EXPECT_TRUE(report["singular_components"].empty());
    EXPECT_GT(report["solve_seconds"], 0.0);
    auto const fit = engine::ReadMesh(folder / "a.obj");
    auto const golden = test::ToRows(test::LoadPoints("golden_surface/icosa_pi_cc_exact.obj"));
    for (Index i = 0; i < golden.rows(); ++i) {
        for (Index c = 0; c < 3; ++c)
            EXPECT_NEAR(fit.positions[static_cast<size_t>(3 * i + c)], golden(i, c), 1e-9);
    }
}

TEST_F(CliFit, EveryMethodIsTaken) {
    for (std::string const method :
         {"progressive", "weighted", "chebyshev", "cg", "direct", "auto"}) {
        EXPECT_EQ(Limn({"fit", grid, "-o", folder / "a.obj", "--method", method, "--report",
                        folder / "r.json", "--quiet"})
                      .status,
                  0)
            << method;
        if (method != "auto") {
            EXPECT_EQ(Report()["method"], method);
        }
        EXPECT_TRUE(Report()["converged"]);
    }
    for (std::string const scheme : {"catmark", "loop"}) {
        EXPECT_EQ(
            Limn({"fit", icosa, "-o", folder / "a.obj", "--scheme", scheme, "--quiet"}).status, 0)
            << scheme;
    }
}

TEST_F(CliFit, TheSameBytesForAnyNumberOfThreads) {
    ASSERT_EQ(
        Limn({"fit", Shape("catmark_car"), "-o", folder / "a.obj", "--threads", "1", "--quiet"})
            .status,
        0);
    ASSERT_EQ(
        Limn({"fit", Shape("catmark_car"), "-o", folder / "b.obj", "--threads", "4", "--quiet"})
            .status,
        0);
    EXPECT_EQ(test::ReadText(folder / "a.obj"), test::ReadText(folder / "b.obj"));
}

TEST_F(CliFit, ASingularMeshInRangeIsSolvedWithAWarning) {
    Outcome const outcome =
        Limn({"fit", cube, "-o", folder / "a.obj", "--report", folder / "r.json"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(Contains(outcome.err, "minimum norm")) << outcome.err;
    EXPECT_EQ(Report()["singular_components"].size(), 1u);
    EXPECT_TRUE(Report()["singular_components"][0]["solved"]);
    EXPECT_EQ(Report()["lambda_min"], 0.0);
}

TEST_F(CliFit, OffTheRangeItIsStatus4AndNothingIsWritten) {
    std::string const mesh = MakePerturbedCube();
    std::string const error =
        ExpectError(Limn({"fit", mesh, "-o", folder / "a.obj", "--report", folder / "r.json"}), 4,
                    "--alpha 0.5");
    EXPECT_TRUE(Contains(error, "component of vertex 0 (8 vertices)")) << error;
    EXPECT_FALSE(Report()["converged"]);
    EXPECT_EQ(folder.List(), (Words{"perturbed.obj", "r.json"}));

    ExpectError(Limn({"fit", mesh, "-o", folder / "kept.obj", "--keep-result"}), 4, "--alpha 0.5");
    EXPECT_EQ(engine::ReadMesh(folder / "kept.obj").cage.numVertices, 8);
}

TEST_F(CliFit, AMeshThatRunsAwayIsStatus4AndSaysWhy) {
    std::string const mesh =
        folder.Write("creased.obj", test::ReadText(cube) + "t crease 2/1/0 0 1 2\n");
    std::string const error =
        ExpectError(Limn({"fit", mesh, "-o", folder / "a.obj", "--report", folder / "r.json"}), 4,
                    "A has no inverse, as far as doubles tell");
    EXPECT_TRUE(Contains(error, "use --alpha 0.5")) << error;
    EXPECT_LT(Report()["lambda_min"], 1e-8);
    EXPECT_EQ(Limn({"fit", mesh, "-o", folder / "a.obj", "--alpha", "0.5"}).status, 0);
}

// A cube of edge 2, whose diagonal is 2 sqrt(3), with an alternating part of 1.001e-6 of that.
TEST_F(CliFit, WhatIsJustBeyondTheToleranceIsToldApartFromIt) {
    std::string text;
    for (int i = 0; i < 8; ++i) {
        int const x = i & 1 ? 1 : -1, y = i & 2 ? 1 : -1, z = i & 4 ? 1 : -1;
        text += fmt::format("v {} {} {}\n", x + x * y * z * 1.001e-6 * std::sqrt(12.0), y, z);
    }
    std::string const mesh = folder.Write(
        "a.obj", text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
    ExpectError(
        Limn({"fit", mesh, "-o", folder / "b.obj"}), 4,
        "are 1.001e-06 of the diagonal off what a limit surface can reach (tolerance 1e-06)");
}

TEST_F(CliFit, AlphaWritesTheFinerMeshUnlessTold) {
    std::string const mesh = MakePerturbedCube();
    ASSERT_EQ(
        Limn({"fit", mesh, "-o", folder / "a.obj", "--alpha", "0.5", "--report", folder / "r.json"})
            .status,
        0);
    EXPECT_EQ(engine::ReadMesh(folder / "a.obj").cage.numVertices, 26);
    EXPECT_LE(Report()["certificate"]["max"], 1.1e-6);
    Outcome const kept =
        Limn({"fit", mesh, "-o", folder / "b.obj", "--alpha", "0.5", "--keep-topology"});
    EXPECT_EQ(kept.status, 0);
    EXPECT_TRUE(Contains(kept.err, "warning")) << kept.err;
    EXPECT_EQ(engine::ReadMesh(folder / "b.obj").cage.numVertices, 8);
}

// The control mesh of the scheme with alpha in every step, which refine subdivides by.
TEST_F(CliFit, StationaryAlphaIsRefinedByRefine) {
    std::string const mesh = MakePerturbedCube(), fit = folder / "a.obj";
    Outcome const outcome =
        Limn({"fit", mesh, "-o", fit, "--alpha", "0.5", "--alpha-rule", "stationary", "--precision",
              "double", "--report", folder / "r.json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(Contains(outcome.err, "as limn refine --alpha does and no other program"));
    EXPECT_LE(Report()["certificate"]["max"], 1.01e-6);
    auto const refine = [&](Words const& more) {
        EXPECT_EQ(Limn(Words{"refine", fit, "-o", folder / "b.obj", "--levels", "2", "--limit",
                             "--precision", "double"} +
                       more)
                      .status,
                  0);
        auto limits = engine::ReadMesh(folder / "b.obj").positions;
        limits.resize(24);
        return test::LargestDifference(limits, engine::ReadMesh(mesh).positions);
    };
    EXPECT_LT(refine({"--alpha", "0.5"}), 1e-5);
    EXPECT_GT(refine({}), 1e-2);
}

TEST_F(CliFit, FiltersTakeTheRuleOfAlpha) {
    auto const filter = [&](Words const& more) {
        EXPECT_EQ(Limn(Words{"denoise", cube, "-o", folder / "a.obj"} + more).status, 0);
        return test::ReadText(folder / "a.obj");
    };
    Words const alpha{"--alpha", "0.5"};
    EXPECT_EQ(filter(alpha), filter(alpha + Words{"--alpha-rule", "first"}));
    EXPECT_NE(filter(alpha), filter(alpha + Words{"--alpha-rule", "stationary"}));
}

TEST_F(CliFit, AtLevelFitsTheRefinedPoints) {
    ASSERT_EQ(Limn({"fit", Shape("catmark_cubes_semisharp"), "-o", folder / "a.obj", "--at-level",
                    "2", "--report", folder / "r.json", "--quiet"})
                  .status,
              0);
    ASSERT_EQ(Limn({"refine", Shape("catmark_cubes_semisharp"), "-o", folder / "b.obj", "--levels",
                    "2", "--quiet"})
                  .status,
              0);
    EXPECT_EQ(engine::ReadMesh(folder / "a.obj").cage.faceVertices,
              engine::ReadMesh(folder / "b.obj").cage.faceVertices);
    EXPECT_TRUE(Report()["converged"]);
}

TEST_F(CliFit, PrimvarsOfAPlyAreFitted) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
        "float z\nproperty float heat\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1\n1 0 0 2\n1 1 "
        "0 3\n0 1 0 5\n4 0 1 2 3\n";
    std::string const mesh = folder.Write("a.ply", text);
    ASSERT_EQ(Limn({"fit", mesh, "-o", folder / "b.ply", "--boundary", "edge-only", "--report",
                    folder / "r.json"})
                  .status,
              0);
    auto const fit = engine::ReadMesh(folder / "b.ply");
    ASSERT_EQ(fit.primvars.size(), 1u);
    auto const& heat = fit.primvars[0].values;  // the boundary curve: (1,4,1)/6 of it is the data
    EXPECT_NEAR((heat[3] + 4 * heat[0] + heat[1]) / 6, 1.0f, 1e-5);
    EXPECT_EQ(Report()["primvars"][0]["name"], "heat");
}

TEST_F(CliFit, UsageErrorsAreStatus2) {
    auto const refuse = [&](std::string const& verb, std::string const& output, Words const& more,
                            std::string const& says) {
        ExpectError(Limn(Words{verb, icosa, "-o", folder / output} + more), 2, says);
    };
    refuse("fit", "a.stl", {}, ".obj or .ply");
    refuse("fit", "a.obj", {"--method", "magic"}, "--method: 'magic' is not one of");
    refuse("fit", "a.obj", {"--tolerance", "0"}, "--tolerance");
    refuse("fit", "a.obj", {"--alpha", "2"}, "--alpha");
    refuse("fit", "a.obj", {"--alpha", "0.5", "--scheme", "loop"}, "of the catmark scheme");
    refuse("fit", "a.obj", {"--keep-topology"}, "--keep-topology: without --alpha");
    refuse("fit", "a.obj", {"--alpha-rule", "stationary"}, "--alpha");
    refuse("fit", "a.obj", {"--alpha", "1", "--alpha-rule", "stationary", "--keep-topology"},
           "--keep-topology: with --alpha-rule stationary");
    refuse("denoise", "a.obj", {"--alpha-rule", "first"}, "--alpha");
    refuse("refine", "a.obj", {"--alpha", "0.5", "--space", "differential"},
           "--alpha is of --space spatial");
    refuse("refine", "a.obj", {"--alpha", "0.5", "--scheme", "loop"}, "alpha");
    refuse("bands", "a", {"--count", "0"}, "--count");
    refuse("sharpen", "a.obj", {"--from-band", "4", "--to-band", "3"}, "is above --to-band");
    refuse("sharpen", "a.obj", {"--from-band", "0"}, "--from-band");
    refuse("morph", "a", {icosa, "--rate", "1"}, "--rate");
    EXPECT_TRUE(folder.List().empty());
}

TEST_F(CliFit, TooFewIterationsAreStatus4WithTheWorstVertex) {
    ExpectError(Limn({"fit", grid, "-o", folder / "a.obj", "--method", "progressive",
                      "--max-iterations", "3"}),
                4, "worst at vertex");
    EXPECT_TRUE(folder.List().empty());
}

TEST_F(CliFit, BandsAddUpToTheInput) {
    ASSERT_EQ(Limn({"bands", icosa, "-o", folder / "a", "--count", "2", "--precision", "double",
                    "--report", folder / "r.json"})
                  .status,
              0);
    auto const input = engine::ReadMesh(icosa);
    std::vector<double> sum(input.positions.size(), 0.0);
    for (char const* name : {"a.band0.obj", "a.band1.obj", "a.remainder.obj"}) {
        auto const band = engine::ReadMesh(folder / name);
        for (size_t i = 0; i < sum.size(); ++i) sum[i] += band.positions[i];
    }
    for (size_t i = 0; i < sum.size(); ++i) EXPECT_NEAR(sum[i], input.positions[i], 1e-13);
    EXPECT_EQ(Report()["outputs"].size(), 3u);
}

TEST_F(CliFit, FiltersReportVolumeAndBoxBeforeAndAfter) {
    for (std::string const verb : {"denoise", "sharpen"}) {
        ASSERT_EQ(Limn({verb, icosa, "-o", folder / "a.obj", "--report", folder / "r.json"}).status,
                  0);
        json const report = Report();
        double const before = report["before"]["volume"], after = report["after"]["volume"];
        EXPECT_EQ(verb == "denoise", after < before);
        EXPECT_EQ(report["after"]["bounding_box"].size(), 2u);
    }
    ASSERT_EQ(Limn({"denoise", grid, "-o", folder / "a.obj", "--report", folder / "r.json"}).status,
              0);
    EXPECT_TRUE(Report()["before"]["volume"].is_null());
}

TEST_F(CliFit, MorphWritesNumberedMeshesOrNone) {
    std::string const mesh = MakePerturbedCube();
    ASSERT_EQ(Limn({"morph", mesh, cube, "-o", folder / "m", "--steps", "3", "--report",
                    folder / "r.json"})
                  .status,
              0);
    EXPECT_EQ(folder.List(),
              (Words{"m.0001.obj", "m.0002.obj", "m.0003.obj", "perturbed.obj", "r.json"}));
    ExpectError(Limn({"morph", icosa, cube, "-o", folder / "n"}), 3, "12 and 8 vertices");
    EXPECT_EQ(folder.List().size(), 5u);
}

TEST_F(CliFit, BrokenMeshesAreStatus3AndNothingIsWritten) {
    for (char const* file :
         {"malformed/test-nan.obj", "malformed/empty.obj", "malformed/invalid_index.obj"}) {
        for (std::string const verb : {"fit", "denoise", "sharpen"})
            ExpectError(Limn({verb, test::DataPath(file), "-o", folder / "a.obj"}), 3, file);
    }
    ExpectError(Limn({"fit", folder / "missing.obj", "-o", folder / "a.obj"}), 5, "missing.obj");
    std::string const file = folder.Write("file", "");
    ExpectError(Limn({"bands", icosa, "-o", file + "/a", "--count", "2"}), 5, "Not a directory");
    EXPECT_EQ(folder.List(), Words{"file"});
}

TEST_F(CliFit, NonManifoldMeshesAndValence2AreFittedWithWarnings) {
    for (auto const& [name, warning] :
         {std::pair{"catmark_nonman_edges", "edges with more than 2 faces"},
          {"catmark_nonman_verts", "vertices where surfaces touch in a point"},
          {"catmark_val2_interior", ""}}) {
        SCOPED_TRACE(name);
        Outcome const outcome =
            Limn({"fit", Shape(name), "-o", folder / "a.obj", "--report", folder / "r.json"});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_TRUE(Contains(outcome.err, warning)) << outcome.err;
        EXPECT_EQ(outcome.err.empty(), std::string(warning).empty()) << outcome.err;
        EXPECT_TRUE(Report()["converged"]);
    }
}

TEST_F(Cli, FitIsCertifiedByOpenSubdivsLimitWhereThatIsWanted) {
    Words const words{"fit",      test::ScenePath("spot/spot.obj"),
                      "-o",       folder / "a.obj",
                      "--report", folder / "r.json"};
    ASSERT_EQ(Limn(words).status, 0);
    json const exact = Report();
    EXPECT_FALSE(exact.contains("far"));
    std::string const mesh = test::ReadText(folder / "a.obj");
    ASSERT_EQ(Limn(words + Words{"--limit-stencils", "far"}).status, 0);
    json const far = Report();
    EXPECT_EQ(test::ReadText(folder / "a.obj"), mesh);
    EXPECT_EQ(far["far"]["places"], far["inputs"][0]["vertices"]);
    EXPECT_NEAR(far["certificate"]["max"].get<double>(), exact["certificate"]["max"].get<double>(),
                2e-7);
    EXPECT_NE(far["certificate"]["max"], exact["certificate"]["max"]);
}

}  // namespace
}  // namespace limn
