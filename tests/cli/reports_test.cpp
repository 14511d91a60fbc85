// SPDX-License-Identifier: Apache-2.0
//
// Reports and progress.

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>

#include <gtest/gtest.h>

#include "engine/io/file.h"
#include "support/program/cli.h"
#include "support/source_tree.h"

namespace limn {
namespace {

using namespace test::cli;

/// A short run of every verb on the mesh; those with an -o write to out.* in the folder.
std::map<std::string, Words> MakeRuns(std::string const& mesh, std::string const& places,
                                      std::string const& folder) {
    auto const out = [&](char const* ending) { return folder + "/out" + ending; };
    return {{"info", {"info", mesh}},
            {"eval", {"eval", mesh, "--at", places}},
            {"measure", {"measure", mesh}},
            {"bake", {"bake", mesh, "-o", out(".exr"), "--maps", "mean", "--size", "32"}},
            {"refine", {"refine", mesh, "-o", out(".obj")}},
            {"fit", {"fit", mesh, "-o", out(".obj")}},
            {"bands", {"bands", mesh, "-o", out(""), "--count", "2"}},
            {"combine", {"combine", mesh, "-o", out(".obj"), "--add", mesh + ":0.5"}},
            {"denoise", {"denoise", mesh, "-o", out(".obj")}},
            {"sharpen", {"sharpen", mesh, "-o", out(".obj")}},
            {"morph", {"morph", mesh, mesh, "-o", out(""), "--steps", "2"}},
            {"smooth", {"smooth", mesh, "-o", out(".obj"), "--levels", "1"}},
            {"field", {"field", mesh, "-o", out(".obj"), "--source", "0", "--sink", "7"}}};
}

class Reports : public Cli {
protected:
    std::string const mesh = Shape("catmark_torus");
    std::map<std::string, Words> const runs =
        MakeRuns(mesh, folder.Write("p.csv", "face,s,t\n0,0.5,0.5\n"), folder.GetPath());
};

TEST_F(Reports, OfEveryVerbHaveTheSharedKeys) {
    Words verbs = ListVerbs(), known;
    for (auto const& [verb, words] : runs) known.push_back(verb);
    std::sort(verbs.begin(), verbs.end());
    EXPECT_EQ(verbs, known);
    for (auto const& [verb, words] : runs) {
        SCOPED_TRACE(verb);
        Words const typed = words + Words{"--report", folder / "r.json"};
        Outcome const outcome = Limn(typed);
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        json const report = Report();
        EXPECT_TRUE(report["limn_version"].is_string());
        EXPECT_EQ(report["command"], verb);
        EXPECT_EQ(report["options"].get<Words>(), typed);
        EXPECT_EQ(report["inputs"][0]["path"], mesh);
        EXPECT_EQ(report["inputs"][0]["sha256"], engine::Sha256OfFile(mesh));
        EXPECT_TRUE(report["warnings"].is_array());
        EXPECT_GE(report["seconds"].get<double>(), 0.0);
        EXPECT_GT(report["peak_bytes"].get<size_t>(), 1u << 20);
        EXPECT_EQ(report["exit_status"], 0);
        EXPECT_TRUE(report["error"].is_null());
        EXPECT_TRUE(report["effective_options"].is_object());
    }
}

TEST_F(Reports, NameTheMeshOfEachOutput) {
    for (char const* verb : {"bake", "bands", "morph"}) {
        SCOPED_TRACE(verb);
        ASSERT_EQ(Limn(runs.at(verb) + Words{"--report", folder / "r.json"}).status, 0);
        json const report = Report();
        for (json const& output : report["outputs"]) EXPECT_EQ(output["mesh"], mesh);
        EXPECT_FALSE(report["outputs"].empty());
    }
}

TEST_F(Reports, TellEveryOptionAsItIsInEffect) {
    ASSERT_EQ(Bake(mesh, "a.exr",
                   {"--half", "--encode", "2,1", "--report", folder / "r.json", "--threads", "2"})
                  .status,
              0);
    json const options = Report()["effective_options"];
    json const expected{// as given
                        {"size", "64"},
                        {"maps", {"mean"}},
                        {"half", "all"},
                        {"encode", "2,1"},
                        {"threads", 2},
                        {"output", folder / "a.exr"},
                        // by default
                        {"padding", 16},
                        {"audit-bound", 1e-3},
                        {"mip", false},
                        {"groups", json::array()},
                        {"seam-bound", json::array()},
                        {"noise-gain", 0.5},
                        {"compression", "zip"},
                        {"orientation", "right"},
                        {"against", nullptr},
                        // by the mesh
                        {"scheme", "catmark"},
                        {"boundary", "edge-and-corner"}};
    for (auto const& [name, value] : expected.items()) EXPECT_EQ(options[name], value) << name;
}

TEST_F(Reports, ListTheOptionsOfTheVerbsHelp) {
    for (auto const& [verb, words] : runs) {
        ASSERT_EQ(Limn(words + Words{"--report", folder / "r.json"}).status, 0);
        json const options = Report()["effective_options"];
        std::string const help = Limn({verb, "--help"}).out;
        std::regex const flag("\n  (?:-\\w,)?--([a-z-]+)");
        std::set<std::string> names;
        for (std::sregex_iterator at(help.begin(), help.end(), flag), end; at != end; ++at)
            names.insert((*at)[1]);
        for (char const* answered : {"help", "version"}) EXPECT_EQ(names.erase(answered), 1u);
        for (std::string const& name : names)
            EXPECT_TRUE(options.contains(name)) << verb << " --" << name;
        EXPECT_EQ(options.size(), names.size()) << verb;
    }
}

TEST_F(Reports, AreWrittenOfRunsThatFail) {
    std::string const report = folder / "r.json";
    std::string const bad = folder.Write("bad.obj", "v 0 0 nonsense\n");
    struct Failure {
        Words words;
        int status;
    };
    for (auto const& [words, status] :
         std::vector<Failure>{{{"info", bad}, 3},
                              {{"refine", folder / "none.obj", "-o", folder / "a.obj"}, 5},
                              {{"fit", mesh, "-o", folder / "a.obj", "--max-iterations", "1",
                                "--tolerance", "1e-12", "--method", "progressive"},
                               4}}) {
        Outcome const outcome = Limn(words + Words{"--report", report});
        std::string const line = ExpectError(outcome, status, "limn: error: ");
        EXPECT_EQ(Report()["exit_status"], status);
        EXPECT_EQ("limn: error: " + Report()["error"].get<std::string>(), line);
        EXPECT_EQ(Report()["command"], words[0]);
        EXPECT_EQ(folder.List(), (Words{"bad.obj", "p.csv", "r.json"}));
        std::filesystem::remove(report);
    }
}

TEST_F(Reports, AreNotWrittenWhereTheCommandIsWrong) {
    Outcome const outcome =
        Bake(mesh, "a.exr", {"--maps", "nonsense", "--report", folder / "r.json"});
    ExpectError(outcome, 2, "nonsense");
    EXPECT_EQ(folder.List(), (Words{"p.csv"}));
}

TEST_F(Reports, SayWhichMeshAnOutputIsOf) {
    std::string const cube = Shape("catmark_cube");
    ASSERT_EQ(Limn({"bake", mesh, cube, "-o", folder / "{mesh}.exr", "--maps", "mean", "--size",
                    "32", "--preview", "--report", folder / "r.json"})
                  .status,
              0);
    json const report = Report();
    EXPECT_EQ(report["outputs"][0]["mesh"], mesh);
    EXPECT_EQ(report["outputs"][1]["mesh"], cube);
    EXPECT_EQ(report["previews"],
              json({folder / "catmark_torus.png", folder / "catmark_cube.png"}));
}

TEST_F(Reports, GoToStdoutWhereTheVerbWritesFilesOnly) {
    for (auto const& [verb, words] : runs) {
        Outcome const outcome = Limn(words + Words{"--report", "-"});
        bool const writesFiles = std::find(words.begin(), words.end(), "-o") != words.end();
        if (!writesFiles) {
            ExpectError(outcome, 2, "--report -: stdout already carries the data");
            continue;
        }
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_EQ(ParseJson(outcome.out)["command"], verb);
    }
}

TEST_F(Cli, BakeReportHasItsKeys) {
    ASSERT_EQ(Bake(Shape("catmark_cube"), "{map}.exr",
                   {"--maps", "mean,normal", "--size", "64x32", "--report", folder / "r.json"})
                  .status,
              0);
    json const report = Report();
    for (char const* key : {"texels_covered", "overlaps", "newton_failures", "moved_samples",
                            "degenerate_samples", "clamped"}) {
        EXPECT_TRUE(report[key].is_number_integer()) << key;
    }
    EXPECT_GT(report["texels_covered"], 0);
    EXPECT_EQ(report["newton_failures"], 0);
    EXPECT_EQ(report["tiles"], json({1001}));
    ASSERT_EQ(report["outputs"].size(), 2u);
    for (json const& output : report["outputs"]) {
        std::string const file = output["file"];
        EXPECT_EQ(output["sha256"], engine::Sha256OfFile(file));
        EXPECT_EQ(output["width"], 64);
        EXPECT_EQ(output["height"], 32);
        EXPECT_EQ(output["tile"], 1001);
        EXPECT_LE(output["min"].get<double>(), output["max"].get<double>());
    }
    EXPECT_EQ(report["outputs"][0]["map"], "mean");
    EXPECT_EQ(report["outputs"][1]["file"], folder / "normal.exr");
}

/// All keys of a JSON value's objects, but those of the options.
void ListKeys(json const& value, std::set<std::string>& keys) {
    if (!value.is_structured()) return;  // a scalar's only item is itself
    for (auto const& [key, member] : value.items()) {
        if (value.is_object()) keys.insert(key);
        if (key != "effective_options") ListKeys(member, keys);
    }
}

TEST_F(Cli, EveryKeyOfABakesReportIsExplained) {
    std::string const mesh = folder.Write(
        "spot.obj", "usemtl skin\n" + test::ReadText(test::ScenePath("spot/spot.obj")));
    Outcome const outcome = Bake(
        mesh, "{map}.{group}.exr",
        {"--maps", "position,displacement", "--against", mesh, "--origin", "auto", "--audit",
         "--picture", "--preview", "--seam-bound", "position=1", "--report", folder / "r.json"});
    ASSERT_TRUE(outcome.status == 0 || outcome.status == 4) << outcome.err;
    std::set<std::string> keys;
    ListKeys(Report(), keys);
    for (char const* key : {"audits", "group", "bound", "origin", "tangential_rms", "pictures"})
        EXPECT_TRUE(keys.contains(key)) << key;
    std::string const page = test::ReadText(test::kSourceRoot / "docs/running.md");
    for (std::string const& key : keys) EXPECT_TRUE(Contains(page, "`" + key + "`")) << key;
}

TEST_F(Cli, ASeamIsWithinOrBeyondABoundOnlyWhereThereIsOne) {
    Outcome const outcome =
        Bake(test::ScenePath("spot/spot.obj"), "{map}.exr",
             {"--maps", "mean,position,normal", "--audit", "--audit-bound", "1", "--seam-bound",
              "position=10,normal=0", "--report", folder / "r.json"});
    ExpectError(outcome, 4, "normal");
    json const seams = Report()["audit"]["seams"];
    EXPECT_EQ(seams[0]["bound"], nullptr);
    EXPECT_EQ(seams[0]["within"], nullptr);
    EXPECT_EQ(seams[1]["within"], true);
    EXPECT_EQ(seams[2]["within"], false);
}

TEST_F(Cli, ReportHoldsTheWarningsEvenWhenQuiet) {
    std::string const mesh =
        folder.Write("m.obj", test::ReadText(Shape("catmark_cube")) + "t vertexedit 1/1/1 0 0 x\n");
    Outcome const outcome = Bake(mesh, "a.exr", {"--report", folder / "r.json"});
    EXPECT_TRUE(outcome.err.empty()) << outcome.err;
    std::string const warnings = Report()["warnings"].dump();
    EXPECT_TRUE(Contains(warnings, "vertexedit")) << warnings;
}

// A bake of a second; shorter ones have nothing to say.
TEST_F(Cli, ProgressWithoutATerminalIsWholeLines) {
    Outcome const outcome =
        Limn({"bake", Shape("catmark_cube"), "-o", folder / "{map}.exr", "--maps", "mean", "--size",
              "1024", "--samples", "8", "--threads", "1"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(outcome.out.empty());
    auto const lines = Lines(outcome.err);
    ASSERT_FALSE(lines.empty());
    for (std::string const& line : lines)
        EXPECT_TRUE(std::regex_match(line, std::regex("limn: .*: [0-9]+ %, [^\r]*"))) << line;
    EXPECT_TRUE(Contains(lines.back(), "100 %")) << lines.back();
}

}  // namespace
}  // namespace limn
