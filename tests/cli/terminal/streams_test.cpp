// SPDX-License-Identifier: Apache-2.0
//
// Standard streams that are closed, and outputs that are links, pipes or devices.

#include <filesystem>
#include <thread>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "support/program/cli.h"

namespace limn {
namespace {

namespace fs = std::filesystem;
using namespace test::cli;

class Streams : public Cli {
protected:
    std::string const cube = Shape("catmark_cube");
    std::string const places = folder.Write("p.csv", "face,s,t\n0,0.5,0.5\n");
};

TEST_F(Streams, ClosedStderrIsAsIfItWereOpen) {
    test::RunOptions const closed{.closed = {STDERR_FILENO}};
    Outcome const open = Limn({"info", cube}), shut = Limn({"info", cube}, closed);
    EXPECT_EQ(shut.status, 0);
    EXPECT_EQ(shut.out, open.out);
    EXPECT_EQ(Limn({"info", folder / "none.obj"}, closed).status, 5);
    // What is said there must not end up in a file that got its number.
    ASSERT_EQ(Bake(cube, "open.exr", {"--maps", "mean,normal"}).status, 0);
    ASSERT_EQ(
        Bake(cube, "shut.exr", {"--maps", "mean,normal", "--progress", "lines"}, closed).status, 0);
    EXPECT_TRUE(test::ReadText(folder / "shut.exr") == test::ReadText(folder / "open.exr"));
}

TEST_F(Streams, StderrThatTakesNothingIsAsIfItDid) {
    std::string const command =
        std::string(LIMN_PROGRAM) + " bake " + cube + " -o " + folder / "a.exr" +
        " --maps mean,normal --size 64 2>/dev/full";  // warns that all go into one file
    EXPECT_EQ(test::Process({"/bin/sh", "-c", command}).Wait().status, 0);
    EXPECT_TRUE(fs::exists(folder / "a.exr"));
}

TEST_F(Streams, AllClosedABakeIsTheSame) {
    ASSERT_EQ(Bake(cube, "open.exr").status, 0);
    ASSERT_EQ(Bake(cube, "shut.exr", {}, {.closed = {0, 1, 2}}).status, 0);
    EXPECT_TRUE(test::ReadText(folder / "shut.exr") == test::ReadText(folder / "open.exr"));
}

TEST_F(Streams, ClosedStdoutIsStatus5WhereDataGoThere) {
    test::RunOptions const closed{.closed = {STDOUT_FILENO}};
    for (Words const& words :
         {Words{"info", cube}, Words{"eval", cube, "--at", places}, Words{"measure", cube},
          Words{"refine", cube, "-o", folder / "a.obj", "--report", "-"}, Words{"--version"},
          Words{"bake", "--help"}})
        ExpectError(Limn(words, closed), 5, "'stdout' cannot be written: Bad file descriptor");
    EXPECT_EQ(Limn({"refine", cube, "-o", folder / "b.obj"}, closed).status, 0);
}

TEST_F(Streams, PipeThatNobodyReadsIsStatus5) {
    std::string rows = "face,s,t\n";  // more than fit into a pipe
    for (int i = 0; i < 5000; ++i) rows += "0,0.5,0.25\n";
    std::string const command = "set -o pipefail; " LIMN_PROGRAM " eval " + cube + " --at " +
                                folder.Write("q.csv", rows) + " | sleep 0";
    ExpectError(test::Process({"/bin/bash", "-c", command}).Wait(), 5,
                "'stdout' cannot be written: Broken pipe");
}

TEST_F(Streams, ReportsGoThroughWhatIsNoFile) {
    fs::create_symlink("/dev/null", folder / "r.json");
    EXPECT_EQ(Limn({"refine", cube, "-o", folder / "a.obj", "--report", folder / "r.json"}).status,
              0);
    EXPECT_TRUE(fs::is_character_file(folder / "r.json"));
    Outcome const shown = Limn({"refine", cube, "-o", folder / "a.obj", "--report", "/dev/stdout"});
    EXPECT_EQ(ParseJson(shown.out)["command"], "refine");
    ExpectError(Limn({"refine", cube, "-o", folder / "a.obj", "--report", "/dev/full"}), 5,
                "'/dev/full' cannot be written: No space left on device");
}

TEST_F(Streams, APipeForAReportIsOpenedWhenThereIsOne) {
    std::string const pipe = folder / "pipe.json";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    // Nobody reads: a run that waited would not end.
    ExpectError(Limn({"measure", cube, "--highlight", "--report", pipe}), 2,
                "name their beginning");
    ExpectError(Limn({"refine", cube, "-o", cube, "--report", pipe}), 2, "is an input");
    std::string heard;
    std::thread reader([&] { heard = test::ReadText(pipe); });
    Outcome const outcome = Limn({"info", folder / "none.obj", "--report", pipe});
    reader.join();
    EXPECT_EQ(outcome.status, 5) << outcome.err;
    EXPECT_EQ(ParseJson(heard)["exit_status"], 5);
    EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(Streams, MeshesGoThroughPipes) {
    std::string const pipe = folder / "pipe.obj";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::string heard;
    std::thread reader([&] { heard = test::ReadText(pipe); });
    Outcome const outcome = Limn({"refine", cube, "-o", pipe});
    reader.join();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(fs::is_fifo(pipe));
    ASSERT_EQ(Limn({"refine", cube, "-o", folder / "a.obj"}).status, 0);
    EXPECT_EQ(heard, test::ReadText(folder / "a.obj"));
}

TEST_F(Streams, LinksStayAndTheirFilesAreReplaced) {
    fs::create_directory(folder / "store");
    fs::create_symlink("store/b.exr", folder / "a.exr");
    for (char const* size : {"32", "64"}) {
        ASSERT_EQ(Bake(cube, "a.exr", {"--size", size}).status, 0);
        EXPECT_TRUE(fs::is_symlink(folder / "a.exr"));
        ASSERT_EQ(Bake(cube, "c.exr", {"--size", size}).status, 0);
        EXPECT_TRUE(test::ReadText(folder / "store/b.exr") == test::ReadText(folder / "c.exr"));
    }
}

TEST_F(Streams, ABakeIntoNullLeavesItAsItIs) {
    fs::create_symlink("/dev/null", folder / "null.exr");
    for (char const* compression : {"zip", "piz"}) {
        Outcome const outcome = Bake(cube, "null.exr",
                                     {"--compression", compression, "--preview", "--skip-existing",
                                      "--report", folder / "r.json"});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_TRUE(fs::is_character_file(folder / "null.exr"));
        EXPECT_TRUE(Report()["outputs"][0]["sha256"].is_null());
    }
    EXPECT_EQ(folder.List(), (Words{"null.exr", "p.csv", "r.json"}));
}

TEST_F(Streams, ABakeIntoAPipeOrADeviceIsStatus2) {
    ASSERT_EQ(::mkfifo((folder / "pipe.exr").c_str(), 0600), 0);
    fs::create_symlink("/dev/full", folder / "full.exr");
    fs::create_symlink("/dev/stdout", folder / "out.exr");
    for (char const* name : {"pipe.exr", "full.exr", "out.exr"})
        ExpectError(Bake(cube, name), 2, "is a pipe or a device");
}

TEST_F(Streams, ATileThatIsAPipeIsRefusedBeforeAnyIsBaked) {
    std::string const mesh = folder.Write(
        "m.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt .1 .1\nvt 1.9 .1\nvt 1.9 .9\nvt .1 .9\n"
        "f 1/1 2/2 3/3 4/4\n");
    ASSERT_EQ(::mkfifo((folder / "1002.exr").c_str(), 0600), 0);
    ExpectError(Bake(mesh, "<UDIM>.exr"), 2, "1002.exr' is a pipe or a device");
    EXPECT_EQ(folder.List(), (Words{"1002.exr", "m.obj", "p.csv"}));
}

}  // namespace
}  // namespace limn
