// SPDX-License-Identifier: Apache-2.0
//
// Runs that are interrupted or killed, and what is left of them.

#include <chrono>
#include <memory>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/cli.h"

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

class Signal : public testing::TestWithParam<int> {};

TEST_P(Signal, EndsALongBakeWithinASecondAndLeavesNothing) {
    test::TemporaryFolder const folder;
    auto const process = StartLongBake(folder);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));  // well into the first band
    auto const start = std::chrono::steady_clock::now();
    process->Send(GetParam());
    Outcome const outcome = process->Wait();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
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

}  // namespace
}  // namespace limn
