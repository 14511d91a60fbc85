// SPDX-License-Identifier: Apache-2.0
//
// Stencil tables of about a million refined vertices, applied again and again: limn's compiled
// tables against OpenSubdiv's CPU evaluator (its general path at length 3, its fast path at length
// 4) and a plain loop over rows; building them against Far::StencilTableFactory; their size.

#include <random>

#include "eval/kernels/instruction_set.h"
#include "eval/stencils/simd_evaluator.h"
#include "far_ext/stencils/refined_stencils.h"
#include "far_ext/topology/refiner.h"
#include "harness.h"
#include "meshes.h"
#include "peers/csr_rows.h"
#include "peers/osd_stencils.h"

namespace limn::bench {
namespace {

using eval::CompiledStencils;
using eval::InstructionSet;
using eval::SimdEvaluator;

constexpr int kTimes = 3;

struct Targets {
    std::optional<double> overLength3, overLength4, build, memory;
};

std::vector<float> MakeValues(Index numPoints, int length, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<float> values(static_cast<size_t>(numPoints) * length);
    for (float& value : values) value = static_cast<float>(random()) * 0x1p-31f - 1.0f;
    return values;
}

void CheckEqual(std::vector<float> const& ours, std::vector<float> const& theirs,
                std::string const& what) {
    double worst = 0.0;
    for (size_t i = 0; i < ours.size(); ++i)
        worst = std::max(worst, std::abs(static_cast<double>(ours[i]) - theirs[i]));
    Check(ours.size() == theirs.size() && worst < 1e-6,
          fmt::format("{} differs from OpenSubdiv by {:.1e}", what, worst));
}

void EvaluateCompiled(CompiledStencils const& table, std::vector<float> const& source,
                      std::vector<float>& target, int length) {
    Osd::BufferDescriptor const desc(0, length, length);
    SimdEvaluator::EvalStencils(source.data(), desc, target.data(), desc, table, 0,
                                table.GetNumStencils());
}

/// Runs `work` with SSE2 only, then as before.
template <class Work>
void WithSse2(Work const& work) {
    InstructionSet const before = eval::GetInstructionSet();
    eval::SelectInstructionSet(InstructionSet::Sse2);
    work();
    eval::SelectInstructionSet(before);
}

void PrintFigure(char const* what, double value, char const* unit,
                 std::optional<double> atMost = {}) {
    fmt::print("  => {}: {:.2f} {}", what, value, unit);
    if (atMost)
        fmt::print(", target at most {}: {}", *atMost, value <= *atMost ? "reached" : "MISSED");
    fmt::print("\n");
}

/// A refined mesh with the tables of limn and of its peers, and room for their results.
struct Subject {
    std::unique_ptr<Far::TopologyRefiner> refiner;
    std::unique_ptr<Far::StencilTable const> far;
    CompiledStencils ours, fromFar;
    std::vector<float> source3, source4, ours3, ours4, theirs3, theirs4;

    Subject(engine::Scene const& scene, int level)
        : refiner(Refine(scene, level)),
          far(MakeFarTable(*refiner)),
          ours(far_ext::BuildRefinedStencils(*refiner)),
          fromFar(CompiledStencils::Compile(*far)),
          source3(MakeValues(far->GetNumControlVertices(), 3, 1)),
          source4(MakeValues(far->GetNumControlVertices(), 4, 2)),
          ours3(static_cast<size_t>(far->GetNumStencils()) * 3),
          ours4(static_cast<size_t>(far->GetNumStencils()) * 4),
          theirs3(ours3),
          theirs4(ours4) {}

    double GetNumRows() const { return far->GetNumStencils(); }

    void EvaluateOsd3() { EvaluateWithOsd(*far, source3.data(), theirs3.data(), 3); }
    void EvaluateOsd4() { EvaluateWithOsd(*far, source4.data(), theirs4.data(), 4); }
    void EvaluatePlain() { EvaluatePlainRows(*far, source3.data(), theirs3.data()); }
    void Evaluate3() { EvaluateCompiled(ours, source3, ours3, 3); }
    void Evaluate4() { EvaluateCompiled(ours, source4, ours4, 4); }
    void EvaluateFromFar() { EvaluateCompiled(fromFar, source3, ours3, 3); }
    void EvaluateRaw() {
        Osd::BufferDescriptor const desc(0, 3, 3);
        SimdEvaluator::EvalStencils(source3.data(), desc, ours3.data(), desc,
                                    far->GetSizes().data(), far->GetOffsets().data(),
                                    far->GetControlIndices().data(), far->GetWeights().data(), 0,
                                    far->GetNumStencils());
    }

private:
    static std::unique_ptr<Far::TopologyRefiner> Refine(engine::Scene const& scene, int level) {
        auto made = far_ext::CreateRefiner(scene.cage);
        made->RefineUniform(Far::TopologyRefiner::UniformOptions(level));
        return made;
    }
};

void CheckResults(Subject& subject) {
    subject.EvaluateOsd3();
    subject.EvaluateOsd4();
    subject.Evaluate3();
    subject.Evaluate4();
    CheckEqual(subject.ours3, subject.theirs3, "length 3");
    CheckEqual(subject.ours4, subject.theirs4, "length 4");
    WithSse2([&] { subject.Evaluate3(); });
    CheckEqual(subject.ours3, subject.theirs3, "length 3 with SSE2");
    subject.EvaluateFromFar();
    CheckEqual(subject.ours3, subject.theirs3, "the compiled table of Far");
}

/// Numbers of the variants that evaluate.
struct Evaluations {
    size_t osd3, osd4, plain, limn3, limn4, sse3, sse4, compiled, raw;
};

Evaluations AddEvaluations(Subject& subject, Rounds& rounds) {
    // Every evaluation several times in a row, as an animation does it.
    auto const add = [&](char const* what, auto const& evaluate) {
        return rounds.Add(
            fmt::format("{}, {} times", what, kTimes),
            [evaluate] {
                for (int i = 0; i < kTimes; ++i) evaluate();
            },
            subject.GetNumRows() * kTimes);
    };
    return {
        .osd3 = add("OpenSubdiv, length 3", [&] { subject.EvaluateOsd3(); }),
        .osd4 = add("OpenSubdiv, length 4", [&] { subject.EvaluateOsd4(); }),
        .plain = add("plain rows, -O3, length 3", [&] { subject.EvaluatePlain(); }),
        .limn3 = add("limn, length 3", [&] { subject.Evaluate3(); }),
        .limn4 = add("limn, length 4", [&] { subject.Evaluate4(); }),
        .sse3 = add("limn, length 3, SSE2 only", [&] { WithSse2([&] { subject.Evaluate3(); }); }),
        .sse4 = add("limn, length 4, SSE2 only", [&] { WithSse2([&] { subject.Evaluate4(); }); }),
        .compiled = add("limn, Far's table compiled, length 3", [&] { subject.EvaluateFromFar(); }),
        .raw = add("limn, Far's table as it stands, length 3", [&] { subject.EvaluateRaw(); })};
}

/// Numbers of the variants that build tables.
struct Builds {
    size_t theirs, ours, compile;
};

Builds AddBuilds(Subject const& subject, Rounds& rounds) {
    double const numRows = subject.GetNumRows();
    return {
        .theirs = rounds.Add(
            "build: Far::StencilTableFactory", [&] { MakeFarTable(*subject.refiner); }, numRows),
        .ours = rounds.Add(
            "build: limn, from the topology",
            [&] { CompiledStencils const table(far_ext::BuildRefinedStencils(*subject.refiner)); },
            numRows),
        .compile = rounds.Add(
            "build: limn, from Far's table", [&] { CompiledStencils::Compile(*subject.far); },
            numRows)};
}

void ReportRatios(Rounds const& rounds, Evaluations const& evaluations, Builds const& builds,
                  Targets const& targets) {
    auto const third = [](std::optional<double> target) {
        return target ? std::optional(std::ceil(*target / 3.0 * 100.0) / 100.0) : target;
    };
    auto const& [osd3, osd4, plain, limn3, limn4, sse3, sse4, compiled, raw] = evaluations;
    rounds.Compare("limn over OpenSubdiv, length 3", limn3, osd3, targets.overLength3);
    rounds.Compare("limn over OpenSubdiv, length 4", limn4, osd4, targets.overLength4);
    rounds.Compare("the same with SSE2 only, length 3", sse3, osd3, third(targets.overLength3));
    rounds.Compare("the same with SSE2 only, length 4", sse4, osd4, third(targets.overLength4));
    rounds.Compare("limn over plain rows", limn3, plain);
    rounds.Compare("Far's table compiled, over OpenSubdiv, length 3", compiled, osd3);
    rounds.Compare("Far's table as it stands, over OpenSubdiv, length 3", raw, osd3);
    rounds.Compare("build from the topology over Far's factory", builds.ours, builds.theirs,
                   targets.build);
    rounds.Compare("compiling Far's table over making it", builds.compile, builds.theirs);
}

void ReportMemory(Subject const& subject, std::optional<double> target) {
    auto const print = [&](char const* what, double bytes, std::optional<double> atMost) {
        PrintFigure(what, bytes / subject.GetNumRows(), "bytes per vertex", atMost);
    };
    print("limn's table", static_cast<double>(subject.ours.GetMemory()), target);
    print("Far's table compiled", static_cast<double>(subject.fromFar.GetMemory()), {});
    print("Far's table", GetMemory(*subject.far), {});
}

void MeasureMesh(char const* name, engine::Scene const& scene, int level, Targets const& targets,
                 int numRounds) {
    Subject subject(scene, level);
    fmt::print(
        "\n{}, level {}: {} control and {} refined vertices, {:.1f} weights each; {} on this CPU\n",
        name, level, subject.far->GetNumControlVertices(), subject.far->GetNumStencils(),
        static_cast<double>(subject.far->GetWeights().size()) / subject.GetNumRows(),
        eval::GetName(eval::GetInstructionSet()));
    CheckResults(subject);
    Rounds rounds(numRounds);
    Evaluations const evaluations = AddEvaluations(subject, rounds);
    Builds const builds = AddBuilds(subject, rounds);
    rounds.Run("vertices");
    ReportRatios(rounds, evaluations, builds, targets);
    ReportMemory(subject, targets.memory);
}

/// Rows of one float, as 1-forms have them: one per edge, 8.5 weights on average, over edges near
/// by.
far_ext::StencilRows MakeFormRows(Index numRows) {
    Index const numControls = numRows / 4;
    std::mt19937 random(3);
    far_ext::StencilRows rows(numControls, 1);
    for (Index row = 0; row < numRows; ++row) {
        int const size = 5 + static_cast<int>(random() % 8);
        for (int k = 0; k < size; ++k) {
            float const weight = static_cast<float>(random()) * 0x1p-35f;
            rows.AddEntry(
                std::min(numControls - 1, row / 4 + 11 * k + static_cast<Index>(random() % 10)),
                &weight);
        }
        rows.EndRow();
    }
    return rows;
}

void MeasureOneColumn(int numRounds) {
    auto const rows = MakeFormRows(3 << 20);
    auto const ours = CompiledStencils::Compile(rows.GetView(), {.isSliced = true});
    double const numRows = rows.GetNumStencils();
    fmt::print("\nOne column: {} rows, {:.1f} weights each\n", rows.GetNumStencils(),
               static_cast<double>(rows.GetWeights().size()) / numRows);
    auto const source = MakeValues(rows.GetNumControlVertices(), 1, 4);
    std::vector<float> target(static_cast<size_t>(numRows)), expected(target);
    EvaluateWithOsd(rows, source.data(), expected.data(), 1);
    EvaluateCompiled(ours, source, target, 1);
    CheckEqual(target, expected, "one column");
    Rounds rounds(numRounds);
    size_t const osd = rounds.Add(
        "OpenSubdiv, length 1", [&] { EvaluateWithOsd(rows, source.data(), expected.data(), 1); },
        numRows);
    size_t const limn =
        rounds.Add("limn, sliced", [&] { EvaluateCompiled(ours, source, target, 1); }, numRows);
    size_t const sse = rounds.Add(
        "limn, sliced, SSE2 only",
        [&] { WithSse2([&] { EvaluateCompiled(ours, source, target, 1); }); }, numRows);
    size_t const two = rounds.Add(
        "limn, sliced, two threads",
        [&] { OnThreads(2, [&] { EvaluateCompiled(ours, source, target, 1); }); }, numRows);
    rounds.Run("rows");
    rounds.Compare("limn over OpenSubdiv, length 1", limn, osd, 8.0);
    rounds.Compare("the same with SSE2 only", sse, osd, 2.67);
    rounds.Compare("the same with two threads", two, osd);
    PrintFigure("limn's table", static_cast<double>(ours.GetMemory()) / numRows, "bytes per row");
}

void MeasureGrowth(int numRounds) {
    fmt::print("\nToruses of 10 k to 10 M refined vertices, level 4, length 3\n");
    struct Case {
        std::unique_ptr<Far::TopologyRefiner> refiner;
        CompiledStencils table;
        std::vector<float> source, target;
    };
    std::vector<std::unique_ptr<Case>> cases;
    std::vector<double> sizes;
    std::vector<size_t> evaluations, builds;
    Rounds rounds(numRounds);
    for (auto const& [n, m] : {std::pair{8, 5}, {20, 20}, {64, 62}, {200, 195}}) {
        auto refiner = far_ext::CreateRefiner(test::MakeTorus(n, m).cage);
        refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(4));
        CompiledStencils table(far_ext::BuildRefinedStencils(*refiner));
        Index const numRows = table.GetNumStencils();
        auto source = MakeValues(table.GetNumControlVertices(), 3, 5);
        cases.push_back(
            std::make_unique<Case>(Case{std::move(refiner), std::move(table), std::move(source),
                                        std::vector<float>(static_cast<size_t>(numRows) * 3)}));
        Case& made = *cases.back();
        sizes.push_back(numRows);
        // Small ones several times over, or the clock would be measured.
        int const times = static_cast<int>(std::max(1.0, 2e6 / numRows));
        evaluations.push_back(rounds.Add(
            fmt::format("evaluate {} vertices, {} times", numRows, times),
            [&made, times] {
                for (int i = 0; i < times; ++i)
                    EvaluateCompiled(made.table, made.source, made.target, 3);
            },
            1.0 * numRows * times));
        builds.push_back(rounds.Add(
            fmt::format("build {} vertices, {} times", numRows, times),
            [&made, times] {
                for (int i = 0; i < times; ++i) far_ext::BuildRefinedStencils(*made.refiner);
            },
            1.0 * numRows * times));
    }
    rounds.Run("vertices");
    auto const fit = [&](char const* what, std::vector<size_t> const& numbers) {
        std::vector<double> seconds;
        for (size_t i = 0; i < sizes.size(); ++i)
            seconds.push_back(rounds.Get(numbers[i]).median /
                              std::floor(std::max(1.0, 2e6 / sizes[i])));
        PrintFigure(fmt::format("{}, exponent", what).c_str(), FitExponent(sizes, seconds), "",
                    1.05);
    };
    fit("evaluation", evaluations);
    fit("build", builds);
}

void MeasureThreads(int numRounds) {
    fmt::print("\nTorus, level 4, length 3, on two threads\n");
    auto const refiner = far_ext::CreateRefiner(test::MakeTorus(64, 64).cage);
    refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(4));
    auto const far = MakeFarTable(*refiner);
    CompiledStencils const ours(far_ext::BuildRefinedStencils(*refiner));
    auto const source = MakeValues(far->GetNumControlVertices(), 3, 6);
    std::vector<float> target(static_cast<size_t>(far->GetNumStencils()) * 3), expected(target);
    EvaluateWithOsd(*far, source.data(), expected.data(), 3);
    OnThreads(2, [&] { EvaluateCompiled(ours, source, target, 3); });
    CheckEqual(target, expected, "two threads");
    Rounds rounds(numRounds);
    size_t const osd = rounds.Add("OpenSubdiv, length 3, one thread", [&] {
        EvaluateWithOsd(*far, source.data(), expected.data(), 3);
    });
    size_t const one = rounds.Add("limn, one thread", [&] {
        OnThreads(1, [&] { EvaluateCompiled(ours, source, target, 3); });
    });
    size_t const two = rounds.Add("limn, two threads", [&] {
        OnThreads(2, [&] { EvaluateCompiled(ours, source, target, 3); });
    });
    rounds.Run();
    rounds.Compare("limn with two threads over OpenSubdiv with one", two, osd);
    rounds.Compare("limn with two threads over one", two, one);
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
    using namespace limn;
    int const numRounds = bench::GetNumRounds(argc, argv);
    bench::OnThreads(1, [&] {
        bench::MeasureMesh("Torus", test::MakeTorus(512, 512), 1, {5.0, 2.0, {}, {}}, numRounds);
        bench::MeasureMesh("Torus", test::MakeTorus(256, 256), 2, {}, numRounds);
        bench::MeasureMesh("Torus", test::MakeTorus(128, 128), 3, {{}, {}, 5.0, 8.0}, numRounds);
        bench::MeasureMesh("Torus", test::MakeTorus(64, 64), 4, {20.0, 7.0, 5.0, 8.0}, numRounds);
        bench::MeasureMesh("Torus with 7 % of its quads inset", bench::MakeInsetTorus(114, 0.07), 3,
                           {{}, {}, 5.0, 8.0}, numRounds);
        bench::MeasureMesh("Torus with 7 % of its quads inset", bench::MakeInsetTorus(57, 0.07), 4,
                           {20.0, 7.0, 5.0, 8.0}, numRounds);
        auto triangles = test::MakeTriangleTorus(52, 52);
        triangles.cage.scheme = Sdc::SCHEME_CATMARK;
        bench::MeasureMesh("Torus of triangles under Catmull-Clark", triangles, 4,
                           {20.0, 7.0, 5.0, 8.0}, numRounds);
        constexpr char const* kHead = "control/ict_head_skin.obj";
        if (test::HasAsset(kHead))
            bench::MeasureMesh(kHead, test::LoadAsset(kHead), 3, {{}, {}, 5.0, 8.0}, numRounds);
        else
            fmt::print("{} is missing: skipped\n", kHead);
        bench::MeasureOneColumn(numRounds);
        bench::MeasureGrowth(numRounds);
    });
    bench::MeasureThreads(numRounds);
    return 0;
}
