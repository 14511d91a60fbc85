// SPDX-License-Identifier: Apache-2.0
//
// Help, and what limn says to a command line that makes no sense.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <regex>

#include <gtest/gtest.h>

#include "support/program/cli.h"

namespace limn {
namespace {

using namespace test::cli;

TEST_F(Cli, VersionGoesToStdout) {
    Outcome const outcome = Limn({"--version"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(std::regex_search(outcome.out, std::regex("^[0-9]+\\.[0-9]+\\.[0-9]+")))
        << outcome.out;
}

TEST_F(Cli, HelpListsTheVerbs) {
    Words const verbs = ListVerbs();
    EXPECT_GE(verbs.size(), 12u);
    for (char const* verb : {"info", "bake", "smooth", "field"})
        EXPECT_EQ(std::count(verbs.begin(), verbs.end(), verb), 1) << verb;
}

/// The lines of a help text below "Example:".
std::string ExampleIn(std::string const& help) {
    size_t const start = help.find("Example:\n");
    return start == std::string::npos ? "" : help.substr(start + 9);
}

TEST_F(Cli, HelpOfEveryVerbShowsAnExample) {
    for (std::string const& verb : ListVerbs()) {
        Outcome const outcome = Limn({verb, "--help"});
        EXPECT_EQ(outcome.status, 0) << verb;
        EXPECT_TRUE(Contains(ExampleIn(outcome.out), "limn " + verb + " ")) << outcome.out;
        EXPECT_TRUE(outcome.err.empty()) << verb;
    }
}

// In a folder with the scenes, and with the files that the examples take to be a user's own.
TEST_F(Cli, EveryExampleOfTheHelpRuns) {
    namespace fs = std::filesystem;
    fs::create_directory_symlink(test::ScenePath(""), folder / "scenes");
    fs::create_directory(folder / "out");
    for (char const* mesh : {"walk.0001.obj", "neutral.obj", "smile.obj"})
        fs::copy(test::ScenePath("spot/spot.obj"), folder / mesh);
    fs::copy(test::DataPath("assets/tri/bob_small.ply"), folder / "scan.ply");
    std::string const path =
        "PATH=" + fs::path(LIMN_PROGRAM).parent_path().string() + ":" + std::getenv("PATH");
    for (std::string const& verb : ListVerbs()) {
        std::string const example = ExampleIn(Limn({verb, "--help"}).out);
        Outcome const outcome = test::Process({"/bin/sh", "-e", "-c", example},
                                              {.environment = {path}, .folder = folder.GetPath()})
                                    .Wait();
        EXPECT_EQ(outcome.status, 0) << example << outcome.err;
        bool const writes = Contains(example, " out/") || Contains(example, "'out/");
        EXPECT_EQ(fs::is_empty(folder / "out"), !writes) << example;
        fs::remove_all(folder / "out");
        fs::create_directory(folder / "out");
    }
}

struct Usage {
    std::string name;
    Words words;  // MESH and OUT/ stand for a mesh and the test's folder
    std::string says;
};

void PrintTo(Usage const& usage, std::ostream* out) {
    *out << usage.name;
}

class CliUsage : public testing::TestWithParam<Usage> {};

TEST_P(CliUsage, EndsWithStatus2OneLineAndNoFile) {
    test::TemporaryFolder const folder;
    Words words = GetParam().words;
    for (std::string& word : words) {
        if (word == "MESH") word = Shape("catmark_cube");
        if (word.starts_with("OUT/")) word = folder / word.substr(4);
    }
    Outcome const outcome = Limn(words);
    ExpectError(outcome, 2, GetParam().says);
    EXPECT_TRUE(outcome.out.empty()) << outcome.out;
    EXPECT_TRUE(folder.List().empty());
}

Words BakeWith(Words const& more) {
    return Words{"bake", "MESH", "-o", "OUT/a.exr"} + more;
}

INSTANTIATE_TEST_SUITE_P(
    Of, CliUsage,
    testing::Values(
        Usage{"NoVerb", {}, "a verb is required"},
        Usage{"UnknownVerb", {"bkae"}, "no verb 'bkae'; did you mean bake?"},
        Usage{"HelpOfAnUnknownVerb", {"help", "bkae"}, "no verb 'bkae'"},
        Usage{"NoShell", {"completion"}, "SHELL is required"},
        Usage{"UnknownShell", {"completion", "csh"}, "bash, zsh, fish"},
        Usage{"NoMesh", {"info"}, "MESH"},
        Usage{"MeshTakenForAMap",
              {"bake", "--maps", "mean", "MESH", "-o", "OUT/a.exr"},
              "files stand before --maps"},
        Usage{"TwoMeshes", {"info", "MESH", "MESH"}, "one argument too many"},
        Usage{"OptionBeforeTheVerb", {"--threads", "2", "info"}, "before the verb"},
        Usage{"LongOptionWithOneDash", {"info", "MESH", "-threads", "2"}, "--threads?"},
        Usage{"UnknownOption", {"info", "MESH", "--frobnicate"}, "--frobnicate"},
        Usage{"ShortOptionWithEquals",
              {"refine", "MESH", "-o=OUT.obj"},
              "write -o OUT.obj, without '='"},
        Usage{"NoOutput", {"bake", "MESH", "--maps", "mean"}, "--output"},
        Usage{"NoMaps", BakeWith({}), "--maps"},
        Usage{"UnknownMap", BakeWith({"--maps", "meen"}), "did you mean mean?"},
        Usage{"SizeZero", BakeWith({"--maps", "mean", "--size", "0"}), "--size"},
        Usage{"SizeTooLarge", BakeWith({"--maps", "mean", "--size", "65537"}), "65536"},
        Usage{"SizeAWord", BakeWith({"--maps", "mean", "--size", "big"}), "'big'"},
        Usage{"SizeHalf", BakeWith({"--maps", "mean", "--size", "64x"}), "--size"},
        Usage{"TileBelow1001", BakeWith({"--maps", "mean", "--tiles", "1000"}), "--tiles"},
        Usage{"TilesBackwards", BakeWith({"--maps", "mean", "--tiles", "1003-1001"}), "--tiles"},
        Usage{"SamplesZero", BakeWith({"--maps", "mean", "--samples", "0"}), "--samples"},
        Usage{"PaddingNegative", BakeWith({"--maps", "mean", "--padding", "-1"}), "--padding"},
        Usage{"UnknownCompression", BakeWith({"--maps", "mean", "--compression", "lzw"}), "lzw"},
        Usage{"EncodeWithoutOffset", BakeWith({"--maps", "mean", "--encode", "0.5"}), "--encode"},
        Usage{"EncodeNan", BakeWith({"--maps", "mean", "--encode", "nan,0"}), "--encode"},
        Usage{"EncodeToNothing", BakeWith({"--maps", "mean", "--encode", "0,1"}), "the scale 0"},
        Usage{"UnknownSpace", BakeWith({"--maps", "mean", "--space", "outer"}), "--space"},
        Usage{"DisplacementOfNothing", BakeWith({"--maps", "displacement"}), "--against"},
        Usage{"TensionOfNothing", BakeWith({"--maps", "tension"}), "--rest"},
        Usage{"SeveralMeshesOneName",
              {"bake", "MESH", "MESH", "-o", "OUT/a.exr", "--maps", "mean"},
              "{mesh}"},
        Usage{"WordTakenForAMesh", BakeWith({"--maps", "mean", "--half", "mean"}),
              "the last 'mean'"},
        Usage{"UnknownGroup", BakeWith({"--maps", "mean", "--groups", "wheel"}),
              "no group 'wheel'"},
        Usage{"UnknownScheme", {"info", "MESH", "--scheme", "doo-sabin"}, "doo-sabin"},
        Usage{"UnknownBoundary", {"info", "MESH", "--boundary", "soft"}, "soft"},
        Usage{"UnknownFVar", {"info", "MESH", "--fvar", "some"}, "some"},
        Usage{"UnknownCreases", {"info", "MESH", "--creases", "sharp"}, "sharp"},
        Usage{"UnknownTriangles", {"info", "MESH", "--triangles", "round"}, "round"},
        Usage{"UnknownOrientation", {"info", "MESH", "--orientation", "up"}, "--orientation"},
        Usage{"UnknownPrecision", {"info", "MESH", "--precision", "half"}, "--precision"},
        Usage{"ThreadsZero", {"info", "MESH", "--threads", "0"}, "--threads"},
        Usage{"ThreadsAWord", {"info", "MESH", "--threads", "all"}, "--threads"},
        Usage{"LevelsEleven", {"refine", "MESH", "-o", "OUT/a.obj", "--levels", "11"}, "--levels"},
        Usage{"UnknownEnding", {"refine", "MESH", "-o", "OUT/a.stl"}, ".obj or .ply"},
        Usage{"PictureOfAnotherKind",
              {"smooth", "MESH", "-o", "OUT/a.ply", "--picture", "OUT/a.jpg"},
              "written as .png"},
        Usage{
            "ViewOfNoPicture", {"measure", "MESH", "-o", "OUT/a", "--view", "0,0,1"}, "--picture"},
        Usage{"IterationsOfAFactorisation",
              {"fit", "MESH", "-o", "OUT/a.obj", "--method", "direct", "--max-iterations", "2"},
              "--max-iterations has no effect"},
        Usage{"OriginAWord", BakeWith({"--maps", "position", "--origin", "middle"}),
              "'middle' is neither X,Y,Z nor auto"},
        Usage{"SeamBoundNegative", BakeWith({"--maps", "mean", "--audit", "--seam-bound", "-1"}),
              "--seam-bound: '-1'"},
        Usage{"AuditBoundNegative", BakeWith({"--maps", "mean", "--audit", "--audit-bound", "-1"}),
              "--audit-bound: '-1'"},
        Usage{"InfoAndReportOnStdout", {"info", "MESH", "--report", "-"}, "--report"},
        Usage{"EvalAndReportOnStdout",
              {"eval", "MESH", "--at", "OUT/p.csv", "--report", "-"},
              "--report"},
        Usage{"FramesWithoutOutput",
              {"eval", "MESH", "--at", "OUT/p.csv", "--frames", "OUT"},
              "--output"},
        Usage{"EvaluatorInDouble",
              {"eval", "MESH", "--at", "OUT/p.csv", "--evaluator", "simd", "--precision", "double"},
              "--evaluator simd works in float; --precision double excludes it"},
        Usage{"UnknownEvaluator",
              {"eval", "MESH", "--at", "OUT/p.csv", "--frames", "OUT", "-o", "OUT/{frame}.csv",
               "--evaluator", "gpu"},
              "gpu"}),
    [](testing::TestParamInfo<Usage> const& instance) { return instance.param.name; });

TEST_F(Cli, UnknownGroupListsTheGroupsThereAre) {
    std::string const mesh = folder.Write(
        "m.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl red\ng left\nf 1/1 2/2 3/3\n");
    ExpectError(Bake(mesh, "a.exr", {"--groups", "red,wheel"}), 2,
                "no group 'wheel'; it has: red, left");
}

TEST_F(Cli, GroupWithoutFacesIsNoCrash) {
    std::string const mesh = folder.Write(
        "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nusemtl late\n");
    ExpectError(Bake(mesh, "a.exr", {"--groups", "late"}), 3, "no texel is covered");
    EXPECT_EQ(folder.List(), (Words{"m.obj"}));
}

}  // namespace
}  // namespace limn
