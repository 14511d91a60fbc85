// SPDX-License-Identifier: Apache-2.0
//
// --evaluator of the verbs that apply a table of weights.

#include <sstream>

#include <gtest/gtest.h>

#include "support/program/cli.h"

namespace limn {
namespace {

using namespace test::cli;

/// The coordinates of an OBJ's vertices.
std::vector<double> ReadVertices(std::string const& path) {
    std::vector<double> values;
    for (std::string const& line : Lines(test::ReadText(path))) {
        if (!line.starts_with("v ")) continue;
        std::istringstream fields(line.substr(2));
        double value = 0.0;
        for (int i = 0; i < 3 && fields >> value; ++i) values.push_back(value);
    }
    return values;
}

/// A verb that applies tables, and the file of it to look at.
struct FilterRun {
    char const* name;
    Words words;
    std::string output;
    Words tables{"A"};
};

void PrintTo(FilterRun const& run, std::ostream* stream) {
    *stream << run.name;
}

class Evaluator : public Cli, public testing::WithParamInterface<FilterRun> {};

INSTANTIATE_TEST_SUITE_P(
    Filters, Evaluator,
    testing::Values(
        FilterRun{"Bands", {"bands", "MESH", "--count", "3"}, "a.band1.obj"},
        FilterRun{"Gains", {"bands", "MESH", "--count", "3", "--gain", "1,2,1"}, "a.gain.obj"},
        FilterRun{"Denoise", {"denoise", "MESH", "--steps", "3"}, "a.obj"},
        FilterRun{"Sharpen", {"sharpen", "MESH"}, "a.obj"},
        FilterRun{"Morph", {"morph", "MESH", "OTHER", "--steps", "4"}, "a.0004.obj"},
        FilterRun{
            "Refine", {"refine", "MESH", "--levels", "2"}, "a.obj", {"S0 face-varying", "S0"}},
        FilterRun{"Limit",
                  {"refine", "MESH", "--levels", "1", "--limit"},
                  "a.obj",
                  {"S0 face-varying", "S0", "A"}},
        FilterRun{"Differential",
                  {"refine", "MESH", "--levels", "2", "--space", "differential", "--handle", "0"},
                  "a.obj",
                  {"S0 face-varying", "S0"}},
        FilterRun{"Fit", {"fit", "MESH", "--tolerance", "1e-6"}, "a.obj"},
        FilterRun{"Smooth",
                  {"smooth", "MESH", "--solver", "jacobi", "--iterations", "20"},
                  "a.obj",
                  {"prolongation", "sweep", "load"}}),
    [](auto const& instance) { return std::string(instance.param.name); });

TEST_P(Evaluator, IsNearTheDoublesAndCountsItsApplications) {
    // Far from the origin, where a coordinate in float would be off by more than is allowed.
    std::string mesh;
    for (std::string const& line : Lines(test::ReadText(test::ScenePath("spot/spot.obj")))) {
        std::string moved = line;
        if (line.starts_with("v ")) {
            std::istringstream fields(line.substr(2));
            double x = 0.0, y = 0.0, z = 0.0;
            fields >> x >> y >> z;
            std::ostringstream text;
            text.precision(17);
            text << "v " << x + 100.0 << ' ' << y << ' ' << z;
            moved = text.str();
        }
        mesh += moved + "\n";
    }
    folder.Write("mesh.obj", mesh);
    ASSERT_EQ(Limn({"denoise", folder / "mesh.obj", "-o", folder / "other.obj"}).status, 0);

    bool const isPrefix = GetParam().output != "a.obj";
    auto const run = [&](std::string const& name, Words const& more) {
        Words words;
        for (std::string word : GetParam().words) {
            if (word == "MESH") word = folder / "mesh.obj";
            if (word == "OTHER") word = folder / "other.obj";
            words.push_back(word);
        }
        Outcome const outcome =
            Limn(words + Words{"-o", folder / (isPrefix ? name : name + ".obj")} + more);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return ReadVertices(folder / (name + GetParam().output.substr(1)));
    };
    auto const expected = run("a", {});
    std::vector<double> ofCpu;
    for (char const* kind : {"osd-cpu", "osd-omp", "simd"}) {
        auto const found = run("b", {"--evaluator", kind, "--report", folder / "r.json"});
        ASSERT_EQ(found.size(), expected.size());
        for (size_t i = 0; i < found.size(); ++i)
            EXPECT_NEAR(found[i], expected[i], 1e-5) << kind << ' ' << i;
        if (ofCpu.empty()) ofCpu = found;
        for (size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], ofCpu[i], 1e-5);
        json const report = Report()["evaluator"];
        EXPECT_EQ(report["name"], kind);
        Words tables;
        for (json const& table : report["tables"]) {
            tables.push_back(table["what"]);
            EXPECT_GE(table["rows"], expected.size() / 3);
            EXPECT_GE(table["applications"], 1);
        }
        EXPECT_EQ(tables, GetParam().tables);
    }
}

TEST_P(Evaluator, ExcludesDouble) {
    Words words;
    for (std::string const& word : GetParam().words)
        words.push_back(word == "MESH" || word == "OTHER" ? test::ScenePath("spot/spot.obj")
                                                          : word);
    ExpectError(Limn(words + Words{"-o", folder / (GetParam().output == "a.obj" ? "a.obj" : "a"),
                                   "--evaluator", "osd-cpu", "--precision", "double"}),
                2, "--evaluator osd-cpu works in float; --precision double excludes it");
    EXPECT_TRUE(folder.List().empty());
}

using EvaluatorOfVerbs = Cli;

TEST_F(EvaluatorOfVerbs, AppliesTheTablesOfMaps) {
    std::string const mesh = test::ScenePath("spot/spot.obj");
    auto const listTables = [&](Words const& more) {
        Outcome const outcome = Bake(
            mesh, folder / "a.exr",
            more + Words{"--size", "32", "--evaluator", "osd-cpu", "--report", folder / "r.json"});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        Words names;
        json const tables = Report()["evaluator"]["tables"];
        for (json const& table : tables) names.push_back(table["what"]);
        return names;
    };
    EXPECT_EQ(listTables({"--maps", "noise"}), (Words{"S0"}));
    EXPECT_EQ(listTables({"--maps", "bands"}), (Words{"A"}));
    ASSERT_EQ(Limn({"field", mesh, "-o", folder / "x.edges.csv", "--levels", "0", "--source", "0",
                    "--sink", "100"})
                  .status,
              0);
    EXPECT_EQ(listTables({"--maps", "field", "--field", folder / "x.edges.csv"}),
              (Words{"S0", "S1", "covectors"}));
}

TEST_F(EvaluatorOfVerbs, IsRefusedWhereNoMapHasTables) {
    ExpectError(Bake(test::ScenePath("spot/spot.obj"), folder / "a.exr",
                     {"--maps", "mean", "--evaluator", "simd"}),
                2, "--evaluator has no effect on mean; it is for bands, noise, field");
}

TEST_F(EvaluatorOfVerbs, AppliesTheTablesOfFields) {
    ASSERT_EQ(Limn({"field", test::ScenePath("spot/spot.obj"), "-o", folder / "x.obj", "--source",
                    "0", "--sink", "100", "--levels", "2", "--evaluator", "osd-cpu", "--report",
                    folder / "r.json"})
                  .status,
              0);
    std::vector<std::string> names;
    json const tables = Report()["evaluator"]["tables"];
    for (json const& table : tables) {
        names.push_back(table["what"]);
        EXPECT_GT(table["rows"], 0);
        EXPECT_GT(table["entries"], 0);
    }
    EXPECT_EQ(names, (Words{"S1", "S2", "S0 face-varying", "S0", "covectors"}));
}

TEST_F(EvaluatorOfVerbs, HasNoTableForAFactorisation) {
    ExpectError(Limn({"fit", test::ScenePath("spot/spot.obj"), "-o", folder / "a.obj", "--method",
                      "direct", "--evaluator", "simd"}),
                2, "--evaluator and --method direct exclude each other");
}

}  // namespace
}  // namespace limn
