// SPDX-License-Identifier: Apache-2.0
//
// Whatever a verb is at, a signal ends it within a second of processor time: while it reads, builds
// tables, factorises, iterates, measures or writes.

#include <chrono>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/io/mesh_writer.h"
#include "support/program/cli.h"

namespace limn {
namespace {

using namespace test::cli;

/// A torus of 90 000 faces with texture coordinates, and places on it.
struct Inputs {
    test::TemporaryFolder folder;
    std::string mesh = folder / "torus.obj", places;

    Inputs() {
        engine::WriteMesh(mesh, test::MakeTorus(300, 300), Precision::Float);
        std::string rows = "face,s,t\n";
        for (int face = 0; face < 90000; ++face) rows += fmt::format("{},0.3,0.7\n", face);
        places = folder.Write("places.csv", rows);
    }
};

Inputs const& GetInputs() {
    static Inputs const inputs;
    return inputs;
}

/// A run of several seconds. OUT and MESH stand for paths.
struct Run {
    char const* name;
    Words words;
};

std::vector<Run> const kRuns{
    {"Info", {"info", "MESH", "--json"}},
    {"Eval", {"eval", "MESH", "--at", "PLACES", "-o", "OUT.csv", "--precision", "double"}},
    {"Measure", {"measure", "MESH", "-o", "OUT", "--picture"}},
    {"Bake", {"bake", "MESH", "-o", "OUT.exr", "--maps", "mean,stretch,noise", "--size", "8192"}},
    {"Refine", {"refine", "MESH", "-o", "OUT.obj", "--levels", "3"}},
    {"RefineDifferential",
     {"refine", "MESH", "-o", "OUT.obj", "--levels", "2", "--space", "differential"}},
    {"RefineCholesky",
     {"refine", "MESH", "-o", "OUT.obj", "--space", "differential", "--solver", "cholesky"}},
    {"Fit", {"fit", "MESH", "-o", "OUT.obj", "--method", "progressive", "--tolerance", "1e-12"}},
    {"FitDirect", {"fit", "MESH", "-o", "OUT.obj", "--method", "direct"}},
    {"Bands", {"bands", "MESH", "-o", "OUT", "--count", "20"}},
    {"BandsOfAnother", {"bands", "MESH", "-o", "OUT.obj", "--from", "MESH", "--bands", "200-"}},
    {"Combine", {"combine", "MESH", "-o", "OUT.obj", "--offset", "MESH,MESH:2"}},
    {"Denoise", {"denoise", "MESH", "-o", "OUT.obj", "--steps", "200"}},
    {"Sharpen", {"sharpen", "MESH", "-o", "OUT.obj", "--steps", "200"}},
    {"Morph", {"morph", "MESH", "MESH", "-o", "OUT", "--steps", "50"}},
    {"Smooth", {"smooth", "MESH", "-o", "OUT.obj", "--levels", "2"}},
    {"Field",
     {"field", "MESH", "-o", "OUT.obj", "--source", "0", "--sink", "1000", "--levels", "2",
      "--harmonic", "1,0"}}};

class Interrupted : public testing::TestWithParam<Run> {};

INSTANTIATE_TEST_SUITE_P(Verbs, Interrupted, testing::ValuesIn(kRuns),
                         [](auto const& instance) { return std::string(instance.param.name); });

TEST_P(Interrupted, EndsWithinASecondOfProcessorTimeAndLeavesNothing) {
    Inputs const& inputs = GetInputs();
    test::TemporaryFolder const folder;
    Words words{LIMN_PROGRAM};
    for (std::string word : GetParam().words) {
        for (size_t at = 0; (at = word.find("MESH", at)) != std::string::npos;
             at += inputs.mesh.size())
            word.replace(at, 4, inputs.mesh);
        if (word == "PLACES") word = inputs.places;
        if (word.starts_with("OUT")) word = folder / word;
        words.push_back(word);
    }
    struct Ask {
        double moment;
        int signal;
    };
    for (auto const [moment, signal] : {Ask{0.05, SIGINT}, Ask{0.6, SIGTERM}}) {
        test::Process process(words);
        while (process.GetProcessorTime() < moment && !process.HasEnded())
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        double const before = process.GetProcessorTime();
        process.Send(signal);
        Outcome const outcome = process.Wait();
        EXPECT_LT(outcome.processorSeconds - before, 1.0) << "at " << moment;
        if (outcome.status == 0) break;  // it was nearly done
        ExpectError(outcome, 128 + signal, "interrupted");
        EXPECT_TRUE(folder.List().empty());
    }
}

// METIS puts a handler of its own on SIGTERM while it orders, good for its own thread only.
TEST(Interrupts, SigtermWhileALibraryHasItsOwnHandlerEndsARunLikeAnyOther) {
    test::TemporaryFolder const folder;
    Words const words{LIMN_PROGRAM, "field", GetInputs().mesh, "-o", folder / "a.obj",
                      "--source",   "0",     "--sink",         "7"};
    for (double const moment : {0.2, 0.3, 0.4}) {
        test::Process process(words);
        while (process.GetProcessorTime() < moment && !process.HasEnded())
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        process.Send(SIGTERM);
        Outcome const outcome = process.Wait();
        if (outcome.status == 0) break;  // it was nearly done
        ExpectError(outcome, 128 + SIGTERM, "interrupted");
    }
}

}  // namespace
}  // namespace limn
