// SPDX-License-Identifier: Apache-2.0
//
// What verbs cost on irregular triangles, as scans have them: whole runs of the command line, files
// included, against `denoise`, which applies the limit matrix a few times and solves nothing; peak
// memory beyond the mesh's own; and how time grows with the mesh.

#include <array>

#include "engine/bake/bake.h"
#include "engine/cli/run_command.h"
#include "engine/fit/fit.h"
#include "engine/io/mesh_writer.h"
#include "engine/measure/measure.h"
#include "engine/scene/refine.h"
#include "eval/surface/vertex_limits.h"
#include "harness.h"
#include "support/files.h"
#include "support/meshes.h"
#include "support/scan_meshes.h"

namespace limn::bench {
namespace {

using engine::Model;
using Words = std::vector<std::string>;

void Run(Words words) {
    engine::MeshFiles files;
    words.insert(words.end(), {"--threads", "1", "--quiet"});
    Check(cli::RunCommand(words, files) == cli::kDone, "limn " + words[0] + " failed");
}

void Judge(std::string const& what, double value, double target) {
    fmt::print("  => {}: {:.3g}, target at most {}: {}\n", what, value, target,
               value <= target ? "reached" : "MISSED");
    std::fflush(stdout);
}

/// Processor time of a run over another's.
double GetRatio(Rounds const& rounds, size_t run, size_t of) {
    return rounds.Get(run).processor / rounds.Get(of).processor;
}

std::string WriteScan(test::TemporaryFolder const& folder, int side) {
    std::string const path = folder / fmt::format("scan{}.obj", side);
    engine::WriteMesh(path, test::MakeScan(side), Precision::Float);
    return path;
}

void MeasureVerbs(int numRounds, test::TemporaryFolder const& folder) {
    std::string const scan = WriteScan(folder, 317), out = folder / "out.ply";
    Rounds rounds(numRounds);
    auto const add = [&](Words words, std::string const& mesh) {
        words.insert(words.begin() + 1, mesh);
        words.insert(words.end(), {"--scheme", "loop"});
        return rounds.Add(words[0] + " " + std::string(mesh == scan ? "scan" : "koala_400k"),
                          [words] { Run(words); });
    };
    fmt::print("\nWhole runs on a scan of 200 k triangles, one thread\n");
    size_t const denoise = add({"denoise", "-o", out}, scan);
    size_t const limit = add({"refine", "-o", out, "--levels", "0", "--limit"}, scan);
    size_t const fit = add({"fit", "-o", out}, scan);
    size_t const measure = add({"measure", "--surface", "limit"}, scan);
    std::string const koala = "large/koala_400k.ply";
    bool const hasKoala = test::HasAsset(koala);
    size_t const koalaDenoise =
        hasKoala ? add({"denoise", "-o", out}, test::AssetPath(koala)) : denoise;
    size_t const koalaFit = hasKoala ? add({"fit", "-o", out}, test::AssetPath(koala)) : fit;
    rounds.Run();
    Judge("refine --limit over denoise, processor time", GetRatio(rounds, limit, denoise), 3.0);
    Judge("fit over denoise", GetRatio(rounds, fit, denoise), 8.0);
    Judge("measure --surface limit over denoise", GetRatio(rounds, measure, denoise), 20.0);
    if (hasKoala)
        Judge("fit of koala_400k over its denoise", GetRatio(rounds, koalaFit, koalaDenoise), 6.0);
    else
        fmt::print("  {} is not there: skipped\n", koala);
}

void MeasureBake(int numRounds, test::TemporaryFolder const& folder) {
    constexpr char const* kHead = "control/ict_head_skin.obj";
    if (!test::HasAsset(kHead)) {
        fmt::print("\n{} is not there: no bakes\n", kHead);
        return;
    }
    std::string const scan = WriteScan(folder, 159), out = folder / "map.<UDIM>.exr";
    Words const options{"-o", out, "--maps", "mean", "--size", "1024"};
    auto const bake = [&](std::string const& mesh, Words const& more) {
        Words words{"bake", mesh};
        for (Words const& list : {options, more})
            words.insert(words.end(), list.begin(), list.end());
        Run(words);
    };
    fmt::print("\nBakes of 1024^2, one thread\n");
    Rounds rounds(numRounds);
    size_t const ofScan =
        rounds.Add("scan of 50 k triangles", [&] { bake(scan, {"--scheme", "loop"}); });
    size_t const ofHead = rounds.Add(kHead, [&] { bake(test::AssetPath(kHead), {}); });
    rounds.Run();
    Judge("bake of the scan over that of ict_head_skin", GetRatio(rounds, ofScan, ofHead), 12.0);
}

template <class Work>
void MeasureMemoryOf(char const* what, engine::Scene const& scan, double meshMegabytes,
                     Work const& work) {
    double const bytes =
        (MeasureMemory([&] { work(Model::Build(scan)); }).growth - meshMegabytes) * 1024.0 * 1024.0;
    Judge(fmt::format("{}, bytes per vertex beyond the mesh and its topology", what),
          bytes / scan.cage.numVertices, 400.0);
}

/// In child processes, so before anything else.
void MeasurePeaks(int side) {
    engine::Scene const scan = test::MakeScan(side);
    double const mesh = MeasureMemory([&] { Model::Build(scan); }).growth;
    fmt::print("Peak memory, scan of {} triangles, two threads; the mesh takes {:.0f} MiB\n",
               scan.cage.GetNumFaces(), mesh);
    MeasureMemoryOf("refine --limit", scan, mesh, [](Model const& model) {
        engine::Job job;
        engine::RefineUniformly(model, {.levels = 0, .toLimit = true}, job);
    });
    MeasureMemoryOf("fit", scan, mesh, [](Model const& model) {
        engine::Job job;
        engine::FitToLimit(model, {}, job);
    });
    MeasureMemoryOf("measure", scan, mesh, [](Model const& model) {
        engine::Job job;
        engine::Measure(model, engine::MeasuredSurface::Limit, Orientation::Right, job);
    });
}

void MeasureGrowth(int numRounds) {
    constexpr std::array<int, 3> kSides{72, 225, 709};
    fmt::print("\nScans of 10 k to 1 M triangles, one thread\n");
    Rounds rounds(numRounds);
    std::vector<double> sizes;
    struct Verb {
        char const* name;
        std::function<void(Model const&)> run;
        std::vector<size_t> numbers;
    };
    std::array<Verb, 3> verbs{
        Verb{"limits of all vertices",
             [](Model const& model) {
                 eval::FindVertexLimits(model.GetRefiner(), 0, model.GetPositions(), 3);
             },
             {}},
        Verb{"fit",
             [](Model const& model) {
                 engine::Job job;
                 engine::FitToLimit(model, {}, job);
             },
             {}},
        Verb{"measure",
             [](Model const& model) {
                 engine::Job job;
                 engine::Measure(model, engine::MeasuredSurface::Limit, Orientation::Right, job);
             },
             {}}};
    for (int side : kSides) {
        Model const model = Model::Build(test::MakeScan(side));
        double const faces = model.GetCage().GetNumFaces();
        sizes.push_back(faces);
        for (Verb& verb : verbs)
            verb.numbers.push_back(rounds.Add(
                fmt::format("{} faces: {}", faces, verb.name),
                [run = verb.run, model] { run(model); }, faces));
    }
    rounds.Run("faces");
    for (Verb const& verb : verbs) {
        std::vector<double> seconds;
        for (size_t number : verb.numbers) seconds.push_back(rounds.Get(number).processor);
        Judge(fmt::format("{}, exponent of processor time", verb.name), FitExponent(sizes, seconds),
              1.05);
    }
}

}  // namespace
}  // namespace limn::bench

/// --rounds N
// NOLINTNEXTLINE(bugprone-exception-escape): what is thrown ends a bench, as it should
int main(int argc, char** argv) {
    using namespace limn::bench;
    int const numRounds = std::min(GetNumRounds(argc, argv), 3);
    MeasurePeaks(709);
    limn::test::TemporaryFolder const folder;
    OnThreads(1, [&] {
        MeasureVerbs(numRounds, folder);
        MeasureBake(numRounds, folder);
        MeasureGrowth(numRounds);
    });
}
