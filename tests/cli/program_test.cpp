// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <regex>
#include <sstream>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/mount.h>

#include "engine/io/file.h"
#include "engine/io/mesh_reader.h"
#include "support/cli.h"
#include "support/meshes.h"

namespace limn {
namespace {

namespace fs = std::filesystem;
using namespace test::cli;

class Cli : public testing::Test {
protected:
    test::TemporaryFolder folder;

    /// A small bake of the mean curvature, unless further words say otherwise.
    Outcome Bake(std::string const& mesh, std::string const& output, Words const& more = {},
                 test::RunOptions const& options = {}) const {
        Words words{"bake", mesh, "-o", folder / output, "--quiet"};
        words.insert(words.end(), more.begin(), more.end());
        auto const has = [&](char const* option) {
            return std::find(more.begin(), more.end(), option) != more.end();
        };
        if (!has("--size")) words.insert(words.end(), {"--size", "64"});
        if (!has("--maps")) words.insert(words.end(), {"--maps", "mean"});
        return Limn(words, options);
    }
};

// -------- help and version

TEST_F(Cli, VersionGoesToStdout) {
    Outcome const outcome = Limn({"--version"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(std::regex_search(outcome.out, std::regex("^[0-9]+\\.[0-9]+\\.[0-9]+")))
        << outcome.out;
}

TEST_F(Cli, HelpOfEveryVerbShowsAnExample) {
    for (std::string const verb : {"info", "eval", "bake", "refine", "measure", "fit", "bands",
                                   "denoise", "sharpen", "morph"}) {
        Outcome const outcome = Limn({verb, "--help"});
        EXPECT_EQ(outcome.status, 0) << verb;
        size_t const example = outcome.out.find("Example:");
        ASSERT_NE(example, std::string::npos) << verb;
        EXPECT_TRUE(Contains(outcome.out.substr(example), "limn " + verb + " ")) << verb;
        EXPECT_TRUE(outcome.err.empty()) << verb;
    }
}

// -------- status 2: usage

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
    std::string const error = ExpectError(outcome, 2);
    EXPECT_TRUE(Contains(error, GetParam().says)) << error;
    EXPECT_TRUE(outcome.out.empty()) << outcome.out;
    EXPECT_TRUE(folder.List().empty());
}

Words BakeWith(Words const& more) {
    Words words{"bake", "MESH", "-o", "OUT/a.exr"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

INSTANTIATE_TEST_SUITE_P(
    Of, CliUsage,
    testing::Values(
        Usage{"NoVerb", {}, "subcommand"}, Usage{"UnknownVerb", {"bkae"}, ""},
        Usage{"NoMesh", {"info"}, "MESH"},
        Usage{"UnknownOption", {"info", "MESH", "--frobnicate"}, "--frobnicate"},
        Usage{"NoOutput", {"bake", "MESH", "--maps", "mean"}, "--output"},
        Usage{"NoMaps", BakeWith({}), "--maps"},
        Usage{"UnknownMap", BakeWith({"--maps", "meen"}), "meen"},
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
        Usage{"UnknownSpace", BakeWith({"--maps", "mean", "--space", "outer"}), "--space"},
        Usage{"DisplacementOfNothing", BakeWith({"--maps", "displacement"}), "--against"},
        Usage{"SeveralMeshesOneName",
              {"bake", "MESH", "MESH", "-o", "OUT/a.exr", "--maps", "mean"},
              "{mesh}"},
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
        Usage{"InfoAndReportOnStdout", {"info", "MESH", "--report", "-"}, "--report"},
        Usage{"EvalAndReportOnStdout",
              {"eval", "MESH", "--at", "OUT/p.csv", "--report", "-"},
              "--report"},
        Usage{"FramesWithoutOutput",
              {"eval", "MESH", "--at", "OUT/p.csv", "--frames", "OUT"},
              "--output"},
        Usage{"EvaluatorWithoutFrames",
              {"eval", "MESH", "--at", "OUT/p.csv", "--evaluator", "simd"},
              "--frames"},
        Usage{"UnknownEvaluator",
              {"eval", "MESH", "--at", "OUT/p.csv", "--frames", "OUT", "-o", "OUT/{frame}.csv",
               "--evaluator", "gpu"},
              "gpu"}),
    [](testing::TestParamInfo<Usage> const& instance) { return instance.param.name; });

TEST_F(Cli, UnknownGroupListsTheGroupsThereAre) {
    std::string const mesh = folder.Write(
        "m.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl red\ng left\nf 1/1 2/2 3/3\n");
    std::string const error = ExpectError(Bake(mesh, "a.exr", {"--groups", "red,wheel"}), 2);
    EXPECT_TRUE(Contains(error, "no group 'wheel'; it has: red, left")) << error;
}

TEST_F(Cli, GroupWithoutFacesIsNoCrash) {
    std::string const mesh = folder.Write(
        "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nusemtl late\n");
    ExpectError(Bake(mesh, "a.exr", {"--groups", "late"}), 3);
    EXPECT_EQ(folder.List(), (Words{"m.obj"}));
}

// -------- status 3: malformed files, as tests/data/malformed/EXPECTED.tsv says

std::string ExpectedOf(std::string const& name) {
    for (std::string const& line :
         Lines(test::ReadText(test::DataPath("malformed/EXPECTED.tsv")))) {
        if (line.starts_with(name + "\t")) return line.substr(line.rfind('\t') + 1);
    }
    throw std::runtime_error("EXPECTED.tsv lacks " + name);
}

/// True if faces name texture coordinates, which a bake needs.
bool HasTextureIndices(std::string const& path) {
    return std::regex_search(test::ReadText(path), std::regex("(^|\n)f +-?[0-9]+/-?[0-9]"));
}

class MalformedFile : public testing::TestWithParam<std::string> {};

TEST_P(MalformedFile, IsAcceptedOrRejectedAsTheTableSays) {
    std::string const expected = ExpectedOf(GetParam()),
                      path = test::DataPath("malformed/" + GetParam());
    bool const mayBeRead = expected.starts_with("ACCEPT") || expected.starts_with("REJECT, or");
    bool const mayBeRejected = !expected.starts_with("ACCEPT") || Contains(expected, "or REJECT");
    for (std::string const verb : {"info", "refine", "bake"}) {
        SCOPED_TRACE(verb);
        test::TemporaryFolder const folder;
        Words words{verb, path};
        if (verb == "refine") words.insert(words.end(), {"-o", folder / "a.obj"});
        if (verb == "bake")
            words.insert(words.end(), {"-o", folder / "a.exr", "--maps", "mean", "--size", "32"});
        Outcome const outcome = Limn(words);
        if (outcome.status == 0) {
            EXPECT_TRUE(mayBeRead);
            EXPECT_EQ(folder.List().size(), verb == "info" ? 0u : 1u);
            // "REJECT, or warn": what was read all the same is named.
            EXPECT_TRUE(!mayBeRejected || std::regex_search(outcome.err + outcome.out,
                                                            std::regex("line [0-9]+|:[0-9]+:")));
            continue;
        }
        std::string const error = ExpectError(outcome, 3);
        EXPECT_TRUE(folder.List().empty());
        EXPECT_TRUE(outcome.out.empty());
        EXPECT_TRUE(Contains(error, path)) << error;
        bool const lacksUVs = verb == "bake" && mayBeRead && !HasTextureIndices(path);
        if (lacksUVs && Contains(error, "no texture coordinates")) continue;
        EXPECT_TRUE(mayBeRejected) << error;
        bool const isEmpty = fs::file_size(path) == 0;
        EXPECT_TRUE(isEmpty || std::regex_search(error, std::regex(R"(\.obj:[0-9]+: )"))) << error;
    }
}

INSTANTIATE_TEST_SUITE_P(Data, MalformedFile, testing::ValuesIn(test::ListData("malformed")),
                         [](testing::TestParamInfo<std::string> const& instance) {
                             std::string name = fs::path(instance.param).stem().string();
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

TEST_F(Cli, CrlfFileRefinesToTheSameBytesAsItsLfTwin) {
    std::string const crlf = test::DataPath("malformed/spot_crlf.obj");
    std::string text = test::ReadText(crlf);
    std::erase(text, '\r');
    folder.Write("lf.obj", text);
    ASSERT_EQ(Limn({"refine", crlf, "-o", folder / "a.obj"}).status, 0);
    ASSERT_EQ(Limn({"refine", folder / "lf.obj", "-o", folder / "b.obj"}).status, 0);
    EXPECT_EQ(test::ReadText(folder / "a.obj"), test::ReadText(folder / "b.obj"));
}

TEST_F(Cli, LoopRefusesAQuadAndNamesIt) {
    std::string const error =
        ExpectError(Limn({"info", Shape("catmark_cube"), "--scheme", "loop"}), 3);
    EXPECT_TRUE(Contains(error, "face 0")) << error;
}

TEST_F(Cli, BakeWithoutTextureCoordinatesIsRefused) {
    ExpectError(Bake(Shape("catmark_pole8"), "a.exr"), 3);
    EXPECT_TRUE(folder.List().empty());
}

TEST_F(Cli, PositionsBeyondFloatReachNoPixel) {
    // No pixel is ever infinite or no number [Bake 4]. To refuse the mesh is as good as to clamp.
    std::string const mesh = folder.Write(
        "m.obj", "v 1e300 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    Outcome const outcome =
        Bake(mesh, "{map}.exr", {"--maps", "position,mean,normal", "--report", folder / "r.json"});
    if (outcome.status == 3) return;
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    json const report = ReadJson(folder / "r.json");
    for (json const& output : report["outputs"]) {
        EXPECT_TRUE(output["min"].is_number() && output["max"].is_number())
            << output;  // JSON has no infinity
    }
}

// -------- status 5: reading and writing

TEST_F(Cli, MissingInputIsStatus5) {
    std::string const none = folder / "none.obj";
    for (Words const& words : {Words{"info", none},
                               {"refine", none, "-o", folder / "a.obj"},
                               {"bake", none, "-o", folder / "a.exr", "--maps", "mean"},
                               {"eval", Shape("catmark_cube"), "--at", folder / "none.obj"}}) {
        EXPECT_TRUE(Contains(ExpectError(Limn(words), 5), none)) << words[0];
    }
    EXPECT_TRUE(folder.List().empty());
}

TEST_F(Cli, FolderAsInputIsStatus5) {
    ExpectError(Limn({"info", folder.GetPath()}), 5);
}

TEST_F(Cli, MissingLastFolderIsMade) {
    EXPECT_EQ(Bake(Shape("catmark_cube"), "new/a.exr").status, 0);
    EXPECT_TRUE(fs::exists(folder / "new/a.exr"));
}

TEST_F(Cli, FolderMadeForABakeThatFailsGoesAgain) {
    std::string const mesh = folder.Write(
        "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt .5 .5\nvt .5001 .5\nvt .5 .5001\nf 1/1 2/2 3/3\n");
    ExpectError(Bake(mesh, "new/{map}.exr", {"--maps", "mean,normal", "--size", "8"}),
                3);  // no texel is covered
    EXPECT_EQ(folder.List(), (Words{"m.obj"}));
    fs::create_directory(folder / "old");
    ExpectError(Bake(mesh, "old/{map}.exr", {"--maps", "mean,normal", "--size", "8"}), 3);
    EXPECT_EQ(folder.List(), (Words{"m.obj", "old"}));
}

TEST_F(Cli, MissingParentFolderIsStatus5) {
    EXPECT_TRUE(Contains(ExpectError(Bake(Shape("catmark_cube"), "no/such/a.exr"), 5), "no/such"));
    ExpectError(Limn({"refine", Shape("catmark_cube"), "-o", folder / "no/such/a.obj"}), 5);
    EXPECT_TRUE(folder.List().empty());
}

TEST_F(Cli, FileWhereAFolderShouldBeIsStatus5) {
    folder.Write("file", "x");
    ExpectError(Bake(Shape("catmark_cube"), "file/a.exr"), 5);
    ExpectError(Limn({"refine", Shape("catmark_cube"), "-o", folder / "file/a.obj"}), 5);
    EXPECT_EQ(folder.List(), (Words{"file"}));
}

TEST_F(Cli, FolderThatCannotBeWrittenIsStatus5) {
    // Nobody, root neither, can make files in /proc.
    ExpectError(Limn({"bake", Shape("catmark_cube"), "-o", "/proc/limn.exr", "--maps", "mean",
                      "--size", "16"}),
                5);
    ExpectError(Limn({"refine", Shape("catmark_cube"), "-o", "/proc/limn.obj"}), 5);
}

TEST_F(Cli, OutputThatIsAFolderIsStatus5AndLeavesNoTemporary) {
    fs::create_directory(folder / "a.exr");
    ExpectError(Bake(Shape("catmark_cube"), "a.exr"), 5);
    EXPECT_EQ(folder.List(), (Words{"a.exr"}));
}

/// A file system of 64 KiB, where the test may mount one.
class FullDisk : public Cli {
protected:
    void SetUp() override {
        fs::create_directory(folder / "disk");
        _isMounted = ::mount("none", Disk().c_str(), "tmpfs", 0, "size=64k") == 0;
        if (!_isMounted) GTEST_SKIP() << "cannot mount a small disk";
    }
    void TearDown() override {
        if (_isMounted) ::umount2(Disk().c_str(), MNT_DETACH);
    }
    std::string Disk() const { return folder / "disk"; }
    void ExpectEmpty() const { EXPECT_TRUE(fs::is_empty(Disk())); }

private:
    bool _isMounted = false;
};

TEST_F(FullDisk, BakeIsStatus5AndLeavesNothing) {
    // 128 x 128 texels of 3 floats are 192 KiB. One way of writing is the engine's own, one
    // OpenEXR's.
    for (std::string const compression : {"none", "zip", "piz"}) {
        Words const more{"--size",        compression == "none" ? "128" : "512",
                         "--maps",        "position",
                         "--compression", compression};
        std::string const error = ExpectError(Bake(Shape("catmark_cube"), "disk/a.exr", more), 5);
        EXPECT_TRUE(Contains(error, "No space left on device")) << error;
        ExpectEmpty();
    }
}

TEST_F(FullDisk, MipsArePartOfTheFile) {
    ExpectError(
        Bake(Shape("catmark_cube"), "disk/a.exr", {"--size", "512", "--maps", "position", "--mip"}),
        5);
    ExpectEmpty();
}

TEST_F(FullDisk, RefineIsStatus5AndLeavesNothing) {
    for (std::string const name : {"disk/a.obj", "disk/a.ply"}) {
        // 6 * 4^5 faces: far more than 64 KiB
        std::string const error = ExpectError(
            Limn({"refine", Shape("catmark_cube"), "-o", folder / name, "--levels", "5"}), 5);
        EXPECT_TRUE(Contains(error, "No space left on device")) << error;
        ExpectEmpty();
    }
}

TEST_F(FullDisk, EvalIsStatus5AndLeavesNothing) {
    std::string places = "face,s,t\n";
    for (int i = 0; i < 1000; ++i) places += fmt::format("{},0.3,0.{:03}\n", i % 6, i);
    std::string const csv = folder.Write("p.csv", places);
    ExpectError(Limn({"eval", Shape("catmark_cube"), "--at", csv, "-o", folder / "disk/a.csv"}), 5);
    ExpectEmpty();
}

TEST_F(Cli, FullStdoutIsStatus5) {
    test::RunOptions const full{.stdoutPath = "/dev/full"};
    std::string const csv = folder.Write("p.csv", "face,s,t\n0,0.5,0.5\n");
    EXPECT_EQ(Limn({"info", Shape("catmark_cube")}, full).status, 5);
    EXPECT_EQ(Limn({"info", Shape("catmark_cube"), "--json"}, full).status, 5);
    EXPECT_EQ(Limn({"eval", Shape("catmark_cube"), "--at", csv}, full).status, 5);
    EXPECT_EQ(Limn({"refine", Shape("catmark_cube"), "-o", folder / "a.obj", "--report", "-"}, full)
                  .status,
              5);
}

TEST_F(Cli, ReportThatCannotBeWrittenIsStatus5WithoutOutput) {
    // Statuses 1, 3 and 5 leave no output.
    ExpectError(Bake(Shape("catmark_cube"), "a.exr", {"--report", folder / "no/such/r.json"}), 5);
    EXPECT_TRUE(folder.List().empty());
}

// -------- signals and leftovers

/// Starts a bake of minutes and waits until its temporary is there.
std::unique_ptr<test::Process> StartLongBake(test::TemporaryFolder const& folder) {
    auto process = std::make_unique<test::Process>(
        Words{LIMN_PROGRAM, "bake", Shape("catmark_cube"), "-o", folder / "a.exr", "--maps",
              "mean,curvature", "--size", "16384", "--samples", "16", "--threads", "2"});
    for (int i = 0; i < 1000; ++i) {
        for (std::string const& name : folder.List()) {
            if (name.ends_with(".tmp")) return process;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    ADD_FAILURE() << "no temporary appeared";
    return process;
}

class Signal : public testing::TestWithParam<int> {};

TEST_P(Signal, EndsALongBakeWithinASecondAndLeavesNothing) {
    test::TemporaryFolder const folder;
    auto const process = StartLongBake(folder);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));  // well into the first band
    auto const start = std::chrono::steady_clock::now();
    process->Send(GetParam());
    Outcome const outcome = process->Wait();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
    ExpectError(outcome, 128 + GetParam());  // 130, 143
    EXPECT_TRUE(folder.List().empty());
}

TEST_P(Signal, LeavesAnOlderFileAsItWas) {
    test::TemporaryFolder const folder;
    folder.Write("a.exr", "an older bake");
    auto const process = StartLongBake(folder);
    process->Send(GetParam());
    EXPECT_EQ(process->Wait().status, 128 + GetParam());
    EXPECT_EQ(folder.List(), (Words{"a.exr"}));
    EXPECT_EQ(test::ReadText(folder / "a.exr"), "an older bake");
}

INSTANTIATE_TEST_SUITE_P(Of, Signal, testing::Values(SIGINT, SIGTERM),
                         [](testing::TestParamInfo<int> const& instance) {
                             return instance.param == SIGINT ? "Interrupt" : "Terminate";
                         });

TEST_F(Cli, TemporariesOfDeadProcessesOfThisHostAreSwept) {
    char host[256] = {};
    ASSERT_EQ(::gethostname(host, sizeof host - 1), 0);
    pid_t const dead = ::fork();
    if (dead == 0) ::_exit(0);
    ::waitpid(dead, nullptr, 0);
    folder.Write(fmt::format(".a.exr.{}.{}.tmp", host, dead), "x");
    folder.Write(fmt::format(".other.obj.{}.{}.tmp", host, dead), "x");
    std::string const alive = fmt::format(".a.exr.{}.{}.tmp", host, ::getpid());
    std::string const elsewhere = fmt::format(".a.exr.not-{}.{}.tmp", host, dead);
    Words expected{alive, elsewhere, ".user.tmp", "b.exr",
                   fmt::format("visible.{}.{}.tmp", host, dead)};
    for (std::string const& name : {expected[0], expected[1], expected[2], expected[4]})
        folder.Write(name, "x");
    ASSERT_EQ(Bake(Shape("catmark_cube"), "b.exr").status, 0);
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(folder.List(), expected);
}

TEST_F(Cli, KilledBakeLeavesATemporaryThatTheNextRunSweeps) {
    {
        auto const process = StartLongBake(folder);
        process->Send(SIGKILL);
        EXPECT_EQ(process->Wait().status, -SIGKILL);
    }
    ASSERT_EQ(folder.List().size(), 1u);
    ASSERT_EQ(Bake(Shape("catmark_cube"), "a.exr").status, 0);
    EXPECT_EQ(folder.List(), (Words{"a.exr"}));
}

// -------- the same bytes

/// Bytes of a bake of everything that can depend on how it was computed.
class SameBytes : public Cli {
protected:
    std::string BytesOf(std::string const& mesh, Words const& more,
                        test::RunOptions const& options = {}) const {
        Words words{"--maps",
                    "position,normal,curvature,principal-direction,curvedness,shape-index,stretch",
                    "--size",
                    "160x96",
                    "--samples",
                    "2",
                    "--padding",
                    "70",
                    "--mip",
                    "--coverage"};
        words.insert(words.end(), more.begin(), more.end());
        Outcome const outcome = Bake(mesh, "a.exr", words, options);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return outcome.status == 0 ? test::ReadText(folder / "a.exr") : outcome.err;
    }
    std::string BytesOfEval(test::RunOptions const& options) const {
        std::string places = "face,s,t\n";
        for (int i = 0; i < 600; ++i)
            places += fmt::format("{},0.{},0.{}\n", i % 32, (i * 7) % 10, (i * 3) % 10);
        Outcome const outcome = Limn({"eval", Shape("catmark_torus_creases0"), "--at",
                                      folder.Write("p.csv", places), "--precision", "double"},
                                     options);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return outcome.out;
    }
};

TEST_F(SameBytes, ForAnyNumberOfThreads) {
    for (std::string const shape :
         {"catmark_torus_creases0", "catmark_cube_corner2", "catmark_nonquads"}) {
        std::string const one = BytesOf(Shape(shape), {"--threads", "1"});
        EXPECT_TRUE(one == BytesOf(Shape(shape), {"--threads", "4"})) << shape;
        EXPECT_TRUE(one == BytesOf(Shape(shape), {"--threads", "3"})) << shape;
    }
}

TEST_F(SameBytes, ForEveryInstructionSet) {
    for (std::string const shape :
         {"catmark_torus_creases0", "catmark_cube_corner2", "catmark_nonquads"}) {
        std::string const plain = BytesOf(Shape(shape), {}, {.environment = {"LIMN_SIMD=sse2"}});
        for (std::string const set : {"avx2", "avx512"}) {
            EXPECT_TRUE(plain == BytesOf(Shape(shape), {}, {.environment = {"LIMN_SIMD=" + set}}))
                << shape << " " << set;
        }
    }
    EXPECT_EQ(BytesOfEval({.environment = {"LIMN_SIMD=sse2"}}),
              BytesOfEval({.environment = {"LIMN_SIMD=avx512"}}));
}

TEST_F(SameBytes, WhateverMathTheCLibraryChooses) {
    // glibc picks its versions of sin, exp, ... by CPU; this hides the wide ones from it.
    test::RunOptions const old{
        .environment = {"GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-AVX512F,-FMA,-AVX512VL,-FMA4"}};
    for (std::string const shape :
         {"catmark_torus_creases0", "catmark_cube_corner2", "catmark_nonquads"}) {
        EXPECT_TRUE(BytesOf(Shape(shape), {}) == BytesOf(Shape(shape), {}, old)) << shape;
    }
    EXPECT_EQ(BytesOfEval({}), BytesOfEval(old));
}

TEST_F(SameBytes, WhereverTheMeshAndTheOutputLie) {
    std::string const mesh = folder.Write("copy.obj", test::ReadText(Shape("catmark_cube")));
    EXPECT_TRUE(BytesOf(Shape("catmark_cube"), {}) ==
                BytesOf("copy.obj", {}, {.folder = folder.GetPath()}));
}

// -------- --skip-existing

class SkipExisting : public Cli {
protected:
    void SetUp() override { ASSERT_EQ(BakeAgain({}).status, 0); }

    Outcome BakeAgain(Words more) const {
        more.insert(more.end(), {"--skip-existing", "--report", folder / "r.json"});
        return Bake(Shape("catmark_cube"), "a.exr", more);
    }

    /// True if a bake with these options writes the file anew.
    bool Rebakes(Words const& more) const {
        auto const old = fs::file_time_type::clock::now() - std::chrono::hours(24);
        fs::last_write_time(folder / "a.exr", old);
        auto const before = fs::last_write_time(folder / "a.exr");
        Outcome const outcome = BakeAgain(more);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        bool const isRewritten = fs::last_write_time(folder / "a.exr") != before;
        EXPECT_EQ(ReadJson(folder / "r.json")["outputs"][0]["skipped"], !isRewritten);
        return isRewritten;
    }
};

TEST_F(SkipExisting, LeavesAFileOfTheSameOptionsAlone) {
    EXPECT_FALSE(Rebakes({}));
    EXPECT_FALSE(Rebakes({"--threads", "1"}));  // no option that affects pixels
    EXPECT_EQ(ReadJson(folder / "r.json")["outputs"][0]["sha256"],
              engine::Sha256OfFile(folder / "a.exr"));
}

TEST_F(SkipExisting, BakesAnewWhereAnOptionChanged) {
    for (Words const& more : {Words{"--size", "32"},
                              {"--maps", "k1"},
                              {"--padding", "3"},
                              {"--half"},
                              {"--samples", "2"},
                              {"--mip"},
                              {"--coverage"},
                              {"--compression", "zips"},
                              {"--orientation", "left"},
                              {"--encode", "2,1"},
                              {"--creases", "chaikin"},
                              {"--fvar", "all"}}) {
        EXPECT_TRUE(Rebakes(more)) << fmt::format("{}", fmt::join(more, " "));
        EXPECT_FALSE(Rebakes(more)) << fmt::format("{}", fmt::join(more, " "));
    }
}

TEST_F(SkipExisting, BakesAnewWhereTheInputChanged) {
    std::string const mesh = folder.Write("m.obj", test::ReadText(Shape("catmark_cube")));
    Words const more{"--skip-existing", "--report", folder / "r.json"};
    ASSERT_EQ(Bake(mesh, "b.exr", more).status, 0);
    ASSERT_EQ(Bake(mesh, "b.exr", more).status, 0);
    EXPECT_EQ(ReadJson(folder / "r.json")["outputs"][0]["skipped"], true);
    folder.Write("m.obj", "# a comment is a change\n" + test::ReadText(mesh));
    ASSERT_EQ(Bake(mesh, "b.exr", more).status, 0);
    EXPECT_EQ(ReadJson(folder / "r.json")["outputs"][0]["skipped"], false);
}

TEST_F(SkipExisting, BakesAnewWhereTheFileIsNotComplete) {
    std::string const whole = test::ReadText(folder / "a.exr");
    for (size_t size : {whole.size() - 1, whole.size() / 2, size_t{10}, size_t{0}}) {
        test::WriteText(folder / "a.exr", whole.substr(0, size));
        EXPECT_TRUE(Rebakes({})) << size;
        EXPECT_TRUE(test::ReadText(folder / "a.exr") == whole) << size;
        test::WriteText(folder / "a.exr", whole);
    }
}

TEST_F(SkipExisting, MakesThePreviewThatIsMissing) {
    ASSERT_EQ(BakeAgain({"--preview"}).status, 0);
    EXPECT_TRUE(fs::exists(folder / "a.png"));
}

// -------- reports

TEST_F(Cli, EveryReportHasTheSharedKeys) {
    std::string const cube = Shape("catmark_cube"),
                      csv = folder.Write("p.csv", "face,s,t\n0,0.5,0.5\n");
    for (Words words : {Words{"info", cube},
                        {"eval", cube, "--at", csv},
                        {"refine", cube, "-o", folder / "a.obj"},
                        {"bake", cube, "-o", folder / "a.exr", "--maps", "mean", "--size", "32"}}) {
        words.insert(words.end(), {"--report", folder / "r.json"});
        ASSERT_EQ(Limn(words).status, 0) << words[0];
        json const report = ReadJson(folder / "r.json");
        for (char const* key :
             {"limn_version", "command", "inputs", "options", "warnings", "seconds"}) {
            EXPECT_TRUE(report.contains(key)) << words[0] << " " << key;
        }
        EXPECT_EQ(report["command"], words[0]);
        EXPECT_EQ(report["inputs"][0]["sha256"], engine::Sha256OfFile(cube));
        EXPECT_TRUE(report["warnings"].is_array());
        EXPECT_GE(report["seconds"].get<double>(), 0.0);
    }
}

TEST_F(Cli, BakeReportHasItsKeys) {
    ASSERT_EQ(Bake(Shape("catmark_cube"), "{map}.exr",
                   {"--maps", "mean,normal", "--size", "64x32", "--report", folder / "r.json"})
                  .status,
              0);
    json const report = ReadJson(folder / "r.json");
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

TEST_F(Cli, ReportMayGoToStdoutWhereTheVerbWritesFiles) {
    Outcome const baked = Bake(Shape("catmark_cube"), "a.exr", {"--report", "-"});
    EXPECT_EQ(json::parse(baked.out)["command"], "bake");
    Outcome const refined =
        Limn({"refine", Shape("catmark_cube"), "-o", folder / "a.obj", "--report", "-"});
    EXPECT_EQ(json::parse(refined.out)["vertices"], 26);
}

TEST_F(Cli, ReportHoldsTheWarningsEvenWhenQuiet) {
    std::string const mesh =
        folder.Write("m.obj", test::ReadText(Shape("catmark_cube")) + "t vertexedit 1/1/1 0 0 x\n");
    Outcome const outcome = Bake(mesh, "a.exr", {"--report", folder / "r.json"});
    EXPECT_TRUE(outcome.err.empty()) << outcome.err;
    std::string const warnings = ReadJson(folder / "r.json")["warnings"].dump();
    EXPECT_TRUE(Contains(warnings, "vertexedit")) << warnings;
}

TEST_F(Cli, ProgressWithoutATerminalIsWholeLines) {
    Outcome const outcome = Limn({"bake", Shape("catmark_cube"), "-o", folder / "{map}.exr",
                                  "--maps", "mean", "--size", "1024"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_FALSE(Contains(outcome.err, "\r"));
    EXPECT_TRUE(outcome.out.empty());
}

// -------- bake's files

/// Two quads, one in tile 1001 and one in 1012.
std::string const kTwoTiles =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 3 0 0\nv 3 1 0\nv 2 1 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 1 1\nvt 2 1\nvt 2 2\nvt 1 2\nusemtl a\nf 1/1 2/2 3/3 "
    "4/4\nusemtl b\nf 5/5 6/6 7/7 8/8\n";

TEST_F(Cli, EveryTileGetsItsFile) {
    std::string const mesh = folder.Write("two.obj", kTwoTiles);
    ASSERT_EQ(Bake(mesh, "{mesh}.{map}.<UDIM>.exr", {"--maps", "mean,position"}).status, 0);
    EXPECT_EQ(folder.List(), (Words{"two.mean.1001.exr", "two.mean.1012.exr", "two.obj",
                                    "two.position.1001.exr", "two.position.1012.exr"}));
}

TEST_F(Cli, TilesAndGroupsChooseWhatIsBaked) {
    std::string const mesh = folder.Write("two.obj", kTwoTiles);
    ASSERT_EQ(Bake(mesh, "t.{udim}.exr", {"--tiles", "1002-1012"}).status, 0);
    ASSERT_EQ(Bake(mesh, "g.{udim}.exr", {"--groups", "a"}).status, 0);
    EXPECT_EQ(folder.List(), (Words{"g.1001.exr", "t.1012.exr", "two.obj"}));
}

TEST_F(Cli, WithoutUdimTokenFacesElsewhereAreNamed) {
    std::string const mesh = folder.Write("two.obj", kTwoTiles);
    Outcome const outcome =
        Limn({"bake", mesh, "-o", folder / "{map}.exr", "--maps", "mean", "--size", "32"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(folder.List(), (Words{"mean.exr", "two.obj"}));
    EXPECT_TRUE(Contains(outcome.err, "face 1 (line 20)")) << outcome.err;
}

TEST_F(Cli, TileWithoutTexelsIsStatus3) {
    ExpectError(Bake(folder.Write("two.obj", kTwoTiles), "a.<UDIM>.exr", {"--tiles", "1005"}), 3);
    EXPECT_EQ(folder.List(), (Words{"two.obj"}));
}

TEST_F(Cli, SeveralMeshesAreBakedToTheirNames) {
    Outcome const outcome =
        Limn({"bake", Shape("catmark_cube"), Shape("catmark_torus"), "-o", folder / "{mesh}.exr",
              "--maps", "mean", "--size", "32", "--quiet"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(folder.List(), (Words{"catmark_cube.exr", "catmark_torus.exr"}));
}

TEST_F(Cli, PreviewIsAPngBesideTheMap) {
    ASSERT_EQ(Bake(Shape("catmark_cube"), "a.exr", {"--preview"}).status, 0);
    EXPECT_TRUE(test::ReadText(folder / "a.png").starts_with("\x89PNG"));
}

// -------- eval

class Eval : public Cli {
protected:
    Outcome At(std::string const& mesh, std::string const& rows, Words const& more = {}) const {
        Words words{"eval", mesh, "--at", folder.Write("p.csv", "face,s,t\n" + rows)};
        words.insert(words.end(), more.begin(), more.end());
        return Limn(words);
    }
};

std::vector<std::string> Fields(std::string const& line) {
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    return fields;
}

TEST_F(Eval, RowsComeInInputOrderWithTheSpecifiedColumns) {
    Outcome const outcome = At(Shape("catmark_cube"), "5,0.25,0.5\n0,0.5,0.5\n5,0.75,0.125\n");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    auto const lines = Lines(outcome.out);
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_EQ(lines[0], "face,s,t,px,py,pz,nx,ny,nz,mean,gaussian,k1,k2,d1x,d1y,d1z");
    EXPECT_TRUE(lines[1].starts_with("5,0.25,0.5,"));
    EXPECT_TRUE(lines[2].starts_with("0,0.5,0.5,"));
    EXPECT_TRUE(lines[3].starts_with("5,0.75,0.125,"));
    for (size_t i = 1; i < 4; ++i) EXPECT_EQ(Fields(lines[i]).size(), 16u);
}

TEST_F(Eval, FlatSheetIsFlat) {
    // The inner quad of a regular 3 x 3 sheet is the identity: x = 1 + s, y = 1 + t, no curvature.
    std::string text;
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) text += fmt::format("v {} {} 0\n", i, j);
    }
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i)
            text += fmt::format("f {} {} {} {}\n", 4 * j + i + 1, 4 * j + i + 2, 4 * j + i + 6,
                                4 * j + i + 5);
    }
    std::string const mesh = folder.Write("sheet.obj", text);
    std::vector<double> row;
    for (std::string const& field : Fields(Lines(At(mesh, "4,0.25,0.75\n").out).at(1)))
        row.push_back(std::stod(field));
    double const expected[] = {4, 0.25, 0.75, 1.25, 1.75, 0, 0, 0, 1,
                               0, 0,    0,    0,    1,    0, 0};  // a1 is the direction at umbilics
    for (size_t i = 0; i < 16; ++i) EXPECT_NEAR(row[i], expected[i], 1e-12) << i;
    row.clear();
    for (std::string const& field :
         Fields(Lines(At(mesh, "4,0.25,0.75\n", {"--orientation", "left"}).out).at(1)))
        row.push_back(std::stod(field));
    EXPECT_NEAR(row[8], -1.0, 1e-12);
}

TEST_F(Eval, DoublePrecisionWritesSeventeenDigits) {
    auto const digits = [](std::string const& field) {
        std::string const mantissa = field.substr(0, field.find('e'));
        return std::count_if(mantissa.begin(), mantissa.end(),
                             [](char c) { return c >= '1' && c <= '9'; });
    };
    std::string const row = "0,0.3,0.7\n";
    EXPECT_LE(digits(Fields(Lines(At(Shape("catmark_bishop"), row).out).at(1)).at(3)), 9);
    EXPECT_GT(
        digits(Fields(Lines(At(Shape("catmark_bishop"), row, {"--precision", "double"}).out).at(1))
                   .at(3)),
        9);
}

TEST_F(Eval, WritesTheSameToAFile) {
    std::string const rows = "0,0.5,0.5\n1,0.25,0.125\n";
    Outcome const outcome = At(Shape("catmark_cube"), rows, {"-o", folder / "out.csv"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(outcome.out.empty());
    EXPECT_EQ(test::ReadText(folder / "out.csv"), At(Shape("catmark_cube"), rows).out);
}

TEST_F(Eval, HoleGivesNanInItsRowAndACount) {
    // catmark_hole_test1: face 1 is a hole.
    Outcome const outcome = At(Shape("catmark_hole_test1"), "0,0.5,0.5\n1,0.5,0.5\n2,0.5,0.5\n",
                               {"--report", folder / "r.json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    auto const lines = Lines(outcome.out);
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_EQ(lines[2], "1,0.5,0.5,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan,nan");
    EXPECT_FALSE(Contains(lines[1], "nan"));
    EXPECT_EQ(ReadJson(folder / "r.json")["places_without_limit"], 1);
}

TEST_F(Eval, CornersOfAPolygonAreItsUnitTiles) {
    // A pentagon's five corners lie in the unit tiles (0,0) (1,0) (2,0) (0,1) (1,1), each [0,1/2]
    // squared.
    std::string const mesh =
        folder.Write("m.obj", "v 0 0 0\nv 2 0 0\nv 3 2 0\nv 1 3 0\nv -1 2 0\nf 1 2 3 4 5\n");
    EXPECT_EQ(At(mesh, "0,0,0\n0,1.25,0.5\n0,2.5,0\n0,0.25,1.25\n0,1.5,1.5\n").status, 0);
    for (std::string const row : {"0,0.6,0", "0,0,0.6", "0,3,0", "0,3.2,0.1", "0,2.1,1.1",
                                  "0,0.1,2.1", "0,-0.1,0", "0,1e300,0"}) {
        std::string const error = ExpectError(At(mesh, row + "\n"), 3);
        EXPECT_TRUE(Contains(error, "row 0")) << row << ": " << error;
    }
    EXPECT_TRUE(
        Contains(ExpectError(At(mesh, "0,nan,0\n"), 3), ":2: 'nan' in column s is no number"));
}

struct BadPlace {
    std::string name, shape, row;
    Words more;
};

void PrintTo(BadPlace const& place, std::ostream* out) {
    *out << place.name;
}

class EvalRefusal : public testing::TestWithParam<BadPlace> {};

TEST_P(EvalRefusal, NamesTheRowAndWritesNothing) {
    test::TemporaryFolder const folder;
    std::string const csv =
        folder.Write("p.csv", "face,s,t\n0,0.25,0.25\n0,0,1\n" + GetParam().row + "\n0,0,0\n");
    Words words{"eval", Shape(GetParam().shape), "--at", csv, "-o", folder / "out.csv"};
    words.insert(words.end(), GetParam().more.begin(), GetParam().more.end());
    std::string const error = ExpectError(Limn(words), 3);
    EXPECT_TRUE(Contains(error, "row 2 (line 4)") || Contains(error, "p.csv:4: ")) << error;
    EXPECT_EQ(folder.List(), (Words{"p.csv"}));
}

INSTANTIATE_TEST_SUITE_P(
    Of, EvalRefusal,
    testing::Values(
        BadPlace{"SAboveOne", "catmark_cube", "0,1.001,0.5", {}},
        BadPlace{"TBelowZero", "catmark_cube", "0,0.5,-0.001", {}},
        BadPlace{"Nan", "catmark_cube", "0,nan,0.5", {}},
        BadPlace{"Infinity", "catmark_cube", "0,0.5,inf", {}},
        BadPlace{"OutsideTheTriangle", "loop_icosahedron", "0,0.6,0.6", {"--scheme", "loop"}},
        BadPlace{"FaceTooLarge", "catmark_cube", "6,0.5,0.5", {}},
        BadPlace{"FaceNegative", "catmark_cube", "-1,0.5,0.5", {}},
        BadPlace{"FaceBeyond32Bits", "catmark_cube", "4294967296,0.5,0.5", {}},
        BadPlace{"FaceAWord", "catmark_cube", "top,0.5,0.5", {}},
        BadPlace{"MissingColumn", "catmark_cube", "0,0.5", {}},
        BadPlace{"NumberWithATail", "catmark_cube", "0,0.5x,0.5", {}}),
    [](testing::TestParamInfo<BadPlace> const& instance) { return instance.param.name; });

TEST_F(Eval, EmptyLinesDoNotShiftTheLineThatIsNamed) {
    std::string const error = ExpectError(At(Shape("catmark_cube"), "0,0.5,0.5\n\n0,9,9\n"), 3);
    EXPECT_TRUE(Contains(error, "line 4")) << error;
}

TEST_F(Eval, ColumnsGoByNameAndFurtherOnesAreIgnored) {
    std::string const csv = folder.Write("q.csv", "t,note,face,s\r\n0.125,x,1,0.25\r\n");
    Outcome const outcome = Limn({"eval", Shape("catmark_cube"), "--at", csv});
    EXPECT_EQ(outcome.out, At(Shape("catmark_cube"), "1,0.25,0.125\n").out);
}

TEST_F(Eval, HeaderThatLacksAColumnIsRefused) {
    for (std::string const text : {"", "face,s\n0,0\n", "0,0.5,0.5\n"}) {
        ExpectError(Limn({"eval", Shape("catmark_cube"), "--at", folder.Write("q.csv", text)}), 3);
    }
}

TEST_F(Eval, FramesGoToFilesOfTheirOwn) {
    std::string const cube = Shape("catmark_cube"),
                      csv = folder.Write("p.csv", "face,s,t\n0,0.5,0.5\n5,0.1,0.2\n");
    for (char const* name : {"cube.9.obj", "cube.10.obj"}) folder.Write(name, test::ReadText(cube));
    Words words{"eval",     cube,
                "--at",     csv,
                "--frames", folder / "cube.{frame}.obj",
                "-o",       folder / "{frame}.csv"};
    auto const with = [&](Words const& more) {
        Words all = words;
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    std::string const alone = Limn({"eval", cube, "--at", csv}).out;
    for (Words const& more : {Words{},
                              {"--evaluator", "simd"},
                              {"--evaluator", "osd-cpu"},
                              {"--evaluator", "osd-omp"}}) {
        Outcome const outcome = Limn(with(more), {.environment = {"OMP_NUM_THREADS=2"}});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_EQ(outcome.out, "");
        for (char const* name : {"9.csv", "10.csv"}) {
            auto const lines = Lines(test::ReadText(folder / name)), expected = Lines(alone);
            ASSERT_EQ(lines.size(), 3u);
            EXPECT_EQ(lines[0], expected[0]);
            for (int column : {3, 4, 5, 6, 7, 8}) {
                EXPECT_NEAR(std::stod(Fields(lines[2])[column]),
                            std::stod(Fields(expected[2])[column]), 1e-6);
            }
        }
    }
    ASSERT_EQ(Limn(with({"--report", folder / "r.json"})).status, 0);
    json const report = ReadJson(folder / "r.json");
    EXPECT_EQ(report["frames"], 2);
    EXPECT_EQ(report["places"], 2);
    EXPECT_EQ(report["evaluator"], "double");
    EXPECT_EQ(report["outputs"][0], folder / "9.csv");
}

TEST_F(Eval, FramesThatCannotBeAreRefused) {
    std::string const cube = Shape("catmark_cube"),
                      csv = folder.Write("p.csv", "face,s,t\n0,0.5,0.5\n");
    auto const run = [&](std::string const& frames, std::string const& output) {
        return Limn(
            {"eval", cube, "--at", csv, "--frames", folder / frames, "-o", folder / output});
    };
    folder.Write("a.1.obj", test::ReadText(cube));
    ExpectError(run("a.{frame}.obj", "a.csv"), 2);
    ExpectError(run("b.{frame}.obj", "{frame}.csv"), 5);
    folder.Write("a.2.obj", test::ReadText(Shape("catmark_pyramid")));
    EXPECT_TRUE(Contains(ExpectError(run("a.{frame}.obj", "{frame}.csv"), 3), "a.2.obj"));
    EXPECT_EQ(folder.List(), (Words{"a.1.obj", "a.2.obj", "p.csv"}));
}

// -------- info

TEST_F(Cli, InfoJsonHasTheSpecifiedKeys) {
    Outcome const outcome = Limn({"info", Shape("catmark_cube_creases0"), "--json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    json const info = json::parse(outcome.out);
    EXPECT_EQ(info["vertices"], 8);
    EXPECT_EQ(info["edges"], 12);
    EXPECT_EQ(info["faces"], 6);
    EXPECT_EQ(info["faces_by_size"], json({{"4", 6}}));
    EXPECT_EQ(info["components"], 1);
    EXPECT_EQ(info["boundary_loops"], 0);
    EXPECT_EQ(info["euler_characteristic"], 2);
    EXPECT_EQ(info["genus"], 0);
    EXPECT_EQ(info["valence"], json({{"min", 3}, {"max", 3}}));
    EXPECT_EQ(info["creases"], 2);
    EXPECT_EQ(info["corners"], 0);
    EXPECT_EQ(info["holes"], 0);
    EXPECT_TRUE(info["groups"].is_array());
    for (char const* key : {"present", "tiles", "overlap_faces", "flipped_faces", "zero_area_faces",
                            "out_of_range_faces"}) {
        EXPECT_TRUE(info["uv"].contains(key)) << key;
    }
    EXPECT_EQ(info["options"]["scheme"], "catmark");
    for (char const* key : {"boundary", "fvar", "creases", "triangles"})
        EXPECT_TRUE(info["options"].contains(key)) << key;
    EXPECT_TRUE(info["defects"].is_array());
}

TEST_F(Cli, InfoJsonNamesDefectsWithTheirLine) {
    json const info =
        json::parse(Limn({"info", test::DataPath("malformed/nonmanifold_edge.obj"), "--json"}).out);
    EXPECT_TRUE(info["genus"].is_null());
    ASSERT_EQ(info["defects"].size(), 1u);
    for (char const* key : {"kind", "element", "line", "message"})
        EXPECT_TRUE(info["defects"][0].contains(key)) << key;
}

TEST_F(Cli, InfoTellsTheEffectiveOptions) {
    // The command line overrides the file's tags; catmark_edgenone has t interpolateboundary 0.
    auto const options = [](Words const& more) {
        Words words{"info", Shape("catmark_edgenone"), "--json"};
        words.insert(words.end(), more.begin(), more.end());
        return json::parse(Limn(words).out)["options"];
    };
    EXPECT_EQ(options({})["boundary"], "none");
    EXPECT_EQ(options({})["fvar"], "corners-plus1");
    json const other = options({"--boundary", "edge-only", "--fvar", "all", "--creases", "chaikin",
                                "--triangles", "smooth", "--scheme", "bilinear"});
    EXPECT_EQ(other, json({{"scheme", "bilinear"},
                           {"boundary", "edge-only"},
                           {"fvar", "all"},
                           {"creases", "chaikin"},
                           {"triangles", "smooth"}}));
}

TEST_F(Cli, InfoJsonStandsNamesThatAreNotUtf8) {
    std::string const mesh =
        folder.Write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl caf\xe9\nf 1 2 3\n");
    Outcome const outcome = Limn({"info", mesh, "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(json::accept(outcome.out)) << outcome.out;
}

// -------- refine

TEST_F(Cli, RefinedCountsFollowFromTheRules) {
    // Quads: V' = V + E + F, E' = 2E + 4F, F' = 4F. Triangles: V' = V + E, E' = 2E + 3F, F' = 4F.
    struct Row {
        std::string shape, scheme;
        int levels;
        Index vertices, faces;
    };
    for (Row const& row : {Row{"catmark_cube", "catmark", 0, 8, 6},
                           {"catmark_cube", "catmark", 1, 26, 24},
                           {"catmark_cube", "catmark", 2, 98, 96},
                           {"loop_icosahedron", "loop", 1, 42, 80},
                           {"loop_icosahedron", "loop", 2, 162, 320}}) {
        for (std::string const ending : {".obj", ".ply"}) {
            std::string const path = folder / "a" + ending;
            Outcome const outcome =
                Limn({"refine", Shape(row.shape), "-o", path, "--scheme", row.scheme, "--levels",
                      std::to_string(row.levels), "--report", folder / "r.json"});
            ASSERT_EQ(outcome.status, 0) << outcome.err;
            engine::Scene const scene = engine::ReadMesh(path);
            EXPECT_EQ(scene.cage.numVertices, row.vertices) << row.shape << row.levels << ending;
            EXPECT_EQ(scene.cage.GetNumFaces(), row.faces) << row.shape << row.levels << ending;
            EXPECT_TRUE(scene.HasUVs());
            EXPECT_EQ(ReadJson(folder / "r.json")["vertices"], row.vertices);
        }
    }
}

TEST_F(Cli, LevelZeroIsTheInputItself) {
    ASSERT_EQ(Limn({"refine", Shape("catmark_bishop"), "-o", folder / "a.obj", "--levels", "0",
                    "--precision", "double"})
                  .status,
              0);
    engine::Scene const before = engine::ReadMesh(Shape("catmark_bishop")),
                        after = engine::ReadMesh(folder / "a.obj");
    EXPECT_EQ(before.positions, after.positions);
    EXPECT_EQ(before.cage.faceVertices, after.cage.faceVertices);
    EXPECT_EQ(before.uvs, after.uvs);
}

TEST_F(Cli, TwoLevelsAreOneLevelTwice) {
    // Tags, rules and UVs are written out, so a refined file refines on as if it had never been
    // one.
    for (std::string const shape :
         {"catmark_cube_creases0", "catmark_edgenone", "catmark_hole_test1", "catmark_chaikin0"}) {
        auto const refine = [&](std::string const& from, std::string const& to,
                                std::string const& levels) {
            ASSERT_EQ(Limn({"refine", from, "-o", folder / to, "--levels", levels, "--precision",
                            "double", "--quiet"})
                          .status,
                      0);
        };
        refine(Shape(shape), "two.obj", "2");
        refine(Shape(shape), "one.obj", "1");
        refine(folder / "one.obj", "again.obj", "1");
        engine::Scene const two = engine::ReadMesh(folder / "two.obj"),
                            again = engine::ReadMesh(folder / "again.obj");
        ASSERT_EQ(two.positions.size(), again.positions.size()) << shape;
        // As point sets: the order within a level follows from how edges were numbered.
        auto const sorted = [](engine::Scene const& scene) {
            std::vector<std::array<double, 3>> points;
            for (size_t i = 0; i < scene.positions.size(); i += 3)
                points.push_back(
                    {scene.positions[i], scene.positions[i + 1], scene.positions[i + 2]});
            for (auto& point : points) {
                for (double& x : point) x = std::round(x * 1e9) / 1e9 + 0.0;
            }
            std::sort(points.begin(), points.end());
            return points;
        };
        EXPECT_EQ(sorted(two), sorted(again)) << shape;
        EXPECT_EQ(two.cage.holes.size(), again.cage.holes.size()) << shape;
    }
}

}  // namespace
}  // namespace limn
