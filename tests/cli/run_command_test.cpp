// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/run_command.h"

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "far_ext/error.h"
#include "support/files.h"
#include "support/meshes.h"

namespace limn::cli {
namespace {

using Words = std::vector<std::string>;

std::string const kCube = test::DataPath("opensubdiv_shapes/catmark_cube.obj");

/// Hands out one cube, whatever it is asked for, and remembers that; calls `onRead` before.
class CubeSource : public engine::MeshSource {
public:
    explicit CubeSource(std::function<void()> onRead = [] {}) : _onRead(std::move(onRead)) {}

    engine::Scene Read(std::string const& mesh) override {
        asked.push_back(mesh);
        _onRead();
        auto scene = engine::ReadMesh(kCube);
        scene.path = mesh;
        return scene;
    }

    Words asked;

private:
    std::function<void()> _onRead;
};

struct Answer {
    int status = -1;
    std::string out, err;

    bool operator==(Answer const&) const = default;
};

Answer Hear(Words const& arguments, engine::MeshSource& meshes,
            std::function<int()> const& getStopStatus = {}) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    int const status = RunCommand(arguments, meshes, getStopStatus);
    return {status, testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
}

Answer Hear(Words const& arguments) {
    engine::MeshFiles files;
    return Hear(arguments, files);
}

TEST(RunCommand, ACommandLeavesNothingToTheNextOne) {
    Answer const first = Hear({"info", kCube, "--json"});
    EXPECT_EQ(first.status, kDone);
    Answer const other = Hear({"info", kCube, "--json", "--boundary", "none"});
    EXPECT_NE(other.out, first.out);
    EXPECT_EQ(Hear({"info", kCube, "--json"}), first);
}

TEST(RunCommand, ARefusedCommandLeavesNothingToTheNextOne) {
    Answer const first = Hear({"info", kCube});
    EXPECT_EQ(Hear({"info", kCube, "--json", "--nonsense"}).status, 2);
    EXPECT_EQ(Hear({"info", kCube}), first);
}

TEST(RunCommand, HelpAndVersionComeBack) {
    EXPECT_EQ(Hear({"--help"}).status, 0);
    EXPECT_EQ(Hear({"bake", "--help"}).status, 0);
    EXPECT_EQ(Hear({"--version"}).status, 0);
}

TEST(RunCommand, CommandsOnSeveralThreadsKeepToThemselves) {
    test::TemporaryFolder const folder;
    auto const refine = [&](std::string const& name, std::string const& levels) {
        engine::MeshFiles files;
        return RunCommand({"refine", kCube, "-o", folder / name, "--levels", levels, "--quiet"},
                          files);
    };
    std::vector<int> statuses(4, -1);
    std::vector<std::thread> threads;
    for (size_t i = 0; i < statuses.size(); ++i) {
        threads.emplace_back([&, i] {
            std::string const level = std::to_string(i);
            statuses[i] = refine("together" + level + ".obj", level);
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (size_t i = 0; i < statuses.size(); ++i) {
        std::string const level = std::to_string(i);
        EXPECT_EQ(statuses[i], kDone);
        ASSERT_EQ(refine("alone" + level + ".obj", level), kDone);
        EXPECT_EQ(test::ReadText(folder / ("together" + level + ".obj")),
                  test::ReadText(folder / ("alone" + level + ".obj")));
    }
}

TEST(RunCommand, MeshesComeFromTheSource) {
    test::TemporaryFolder const folder;
    CubeSource cubes;
    EXPECT_EQ(
        Hear({"morph", "a.usd<Cube>", "b.usd<Cube>", "-o", folder / "x", "--steps", "1"}, cubes)
            .status,
        kDone);
    EXPECT_EQ(cubes.asked, (Words{"a.usd<Cube>", "b.usd<Cube>"}));
}

TEST(RunCommand, OptionsOverrideWhatTheSourceSays) {
    CubeSource cubes;
    auto const answer = Hear({"info", "cube", "--scheme", "bilinear"}, cubes);
    EXPECT_NE(answer.out.find("scheme=bilinear"), std::string::npos) << answer.out;
}

TEST(RunCommand, AnErrorOfTheSourceIsTheCommands) {
    CubeSource missing([] { throw Error(ErrorCode::Io, "no such prim"); });
    EXPECT_EQ(Hear({"info", "x"}, missing), (Answer{5, "", "limn: error: no such prim\n"}));
}

TEST(RunCommand, ItStopsWhenAskedToAndLeavesNothing) {
    test::TemporaryFolder const folder;
    std::atomic<bool> isStopped{false};
    CubeSource cubes([&] { isStopped = true; });
    auto const answer =
        Hear({"bake", "cube", "-o", folder / "x.exr", "--maps", "mean", "--size", "64"}, cubes,
             [&] { return isStopped ? 143 : 0; });
    EXPECT_EQ(answer.status, 143);
    EXPECT_EQ(answer.err, "limn: error: interrupted; nothing half-written is left\n");
    EXPECT_TRUE(folder.List().empty());
}

TEST(RunCommand, FewThreadsForOneCommandAreNoLimitToTheProcess) {
    auto const limit = [] {
        return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    };
    size_t const before = limit();
    size_t during = 0;
    CubeSource cubes([&] { during = limit(); });
    EXPECT_EQ(Hear({"info", "cube", "--threads", "1"}, cubes).status, kDone);
    EXPECT_EQ(during, before);
}

}  // namespace
}  // namespace limn::cli
