// SPDX-License-Identifier: Apache-2.0
//
// Runs that are interrupted or killed, and what is left of them.

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/io/file.h"
#include "support/program/cli.h"

namespace limn {
namespace {

using namespace test::cli;

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

/// Waits until the process takes signals in its own way; before that the system's way ends it.
void WaitUntilSignalsAreTaken(test::Process const& process) {
    std::string const path = "/proc/" + std::to_string(process.GetPid()) + "/status";
    for (int i = 0; i < 10000; ++i) {
        std::ifstream status(path);
        for (std::string line; std::getline(status, line);) {
            if (!line.starts_with("SigBlk:")) continue;
            if (std::stoull(line.substr(7), nullptr, 16) & (1ull << (SIGINT - 1))) return;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ADD_FAILURE() << "signals are not blocked";
}

class Signal : public testing::TestWithParam<int> {};

TEST_P(Signal, EndsALongBakeWithinASecondAndLeavesNothing) {
    test::TemporaryFolder const folder;
    auto const process = StartLongBake(folder);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));  // well into the first band
    double const before = process->GetProcessorTime();
    process->Send(GetParam());
    Outcome const outcome = process->Wait();
    EXPECT_LT(outcome.processorSeconds - before, 1.0);
    ExpectError(outcome, 128 + GetParam(), "interrupted");  // 130, 143
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

std::string NameSignal(testing::TestParamInfo<int> const& instance) {
    switch (instance.param) {
        case SIGINT:
            return "Interrupt";
        case SIGTERM:
            return "Terminate";
        default:
            return "HangUp";
    }
}

INSTANTIATE_TEST_SUITE_P(Of, Signal, testing::Values(SIGINT, SIGTERM, SIGHUP), NameSignal);

TEST_F(Cli, HangUpThatIsIgnoredStaysSo) {
    Words const words{
        LIMN_PROGRAM, "bake", Shape("catmark_cube"), "-o", folder / "a.exr", "--maps", "mean",
        "--size",     "512",  "--samples",           "4",  "--quiet"};
    test::Process process(words, {.ignoredSignal = SIGHUP});
    WaitUntilSignalsAreTaken(process);
    process.Send(SIGHUP);
    EXPECT_EQ(process.Wait().status, 0);
    EXPECT_EQ(folder.List(), (Words{"a.exr"}));
}

TEST_F(Cli, InterruptedBakeReportsTheFilesThatStay) {
    // Few texels in the first tile, and a minute's worth of them in the second.
    std::string const mesh = folder.Write(
        "m.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
        "vt .1 .1\nvt .12 .1\nvt .12 .12\nvt .1 .12\nvt 1.1 .1\nvt 1.9 .1\nvt 1.9 .9\nvt 1.1 .9\n"
        "v 2 0 0\nv 3 0 0\nv 3 1 0\nv 2 1 0\nf 1/1 2/2 3/3 4/4\nf 5/5 6/6 7/7 8/8\n");
    test::Process process({LIMN_PROGRAM, "bake", mesh, "-o", folder / "<UDIM>.exr", "--maps",
                           "mean", "--size", "1024", "--samples", "16", "--threads", "2",
                           "--report", folder / "r.json"});
    auto const first = folder / "1001.exr";
    for (int i = 0; i < 60000 && !std::filesystem::exists(first); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    process.Send(SIGTERM);
    ExpectError(process.Wait(), 143, "interrupted");
    EXPECT_EQ(folder.List(), (Words{"1001.exr", "m.obj", "r.json"}));
    json const report = Report();
    EXPECT_EQ(report["exit_status"], 143);
    EXPECT_TRUE(Contains(report["error"], "interrupted"));
    ASSERT_EQ(report["outputs"].size(), 1u);
    EXPECT_EQ(report["outputs"][0]["file"], first);
    EXPECT_EQ(report["outputs"][0]["sha256"], engine::Sha256OfFile(first));
}

TEST_F(Cli, PipeThatNobodyWritesToCanBeInterrupted) {
    std::string const pipe = folder / "mesh.obj";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    test::Process process(
        {LIMN_PROGRAM, "refine", pipe, "-o", folder / "a.obj", "--report", folder / "r.json"});
    WaitUntilSignalsAreTaken(process);
    process.Send(SIGINT);
    ExpectError(process.Wait(), 130, "interrupted");
    EXPECT_EQ(folder.List(), (Words{"mesh.obj", "r.json"}));
    EXPECT_EQ(Report()["exit_status"], 130);
}

TEST_F(Cli, PipeThatNobodyReadsCanBeInterrupted) {
    std::string const pipe = folder / "a.obj";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    test::Process process({LIMN_PROGRAM, "refine", Shape("catmark_cube"), "-o", pipe});
    WaitUntilSignalsAreTaken(process);
    process.Send(SIGINT);
    ExpectError(process.Wait(), 130, "interrupted");
}

TEST_F(Cli, PipeForAReportThatNobodyReadsCanBeInterrupted) {
    std::string const pipe = folder / "r.json", mesh = folder / "mesh.obj";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    ASSERT_EQ(::mkfifo(mesh.c_str(), 0600), 0);
    for (std::string const& input : {Shape("catmark_cube"), mesh}) {  // writes, or still reads
        test::Process process(
            {LIMN_PROGRAM, "refine", input, "-o", folder / "a.obj", "--report", pipe});
        WaitUntilSignalsAreTaken(process);
        process.Send(SIGINT);
        ExpectError(process.Wait(), 130, "interrupted");
    }
}

TEST_F(Cli, FullStderrThatNobodyReadsCanBeInterrupted) {
    std::string const pipe = folder / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    int const end = ::open(pipe.c_str(), O_RDWR | O_NONBLOCK);
    while (::write(end, "x", 1) == 1) continue;
    test::Process process({LIMN_PROGRAM, "bake", Shape("catmark_cube"), "-o", folder / "a.exr",
                           "--maps", "mean,normal"},  // warns that all go into one file
                          {.stderrPath = pipe});
    WaitUntilSignalsAreTaken(process);
    process.Send(SIGINT);
    EXPECT_EQ(process.Wait().status, 130);
    EXPECT_EQ(folder.List(), (Words{"pipe"}));
    ::close(end);
}

}  // namespace
}  // namespace limn
