// SPDX-License-Identifier: Apache-2.0
//
// Stencil tables of 1-forms and 2-forms: building one level's S1 and S2 against
// Far::StencilTableFactory's S0 of the same level, applying S1 against the same rows through
// Osd::CpuEvaluator, four forms at once against one, and growth.

#include <opensubdiv/osd/cpuEvaluator.h>

#include "eval/stencils/simd_evaluator.h"
#include "far_ext/forms/form_operators.h"
#include "far_ext/forms/form_stencils.h"
#include "far_ext/topology/refiner.h"
#include "harness.h"
#include "support/meshes.h"
#include "support/stencils.h"

namespace limn::bench {
namespace {

namespace Osd = OpenSubdiv::Osd;

std::unique_ptr<Far::TopologyRefiner> MakeRefiner(engine::Scene const& scene) {
    auto refiner = far_ext::CreateRefiner(scene.cage);
    Far::TopologyRefiner::UniformOptions options(1);
    options.fullTopologyInLastLevel = true;
    refiner->RefineUniform(options);
    return refiner;
}

/// The law the tables obey, on a form without pattern: d1 S1 w = S2 d1 w.
void CheckCommutation(Far::TopologyRefiner const& refiner, far_ext::FormStencils const& forms) {
    auto const noise =
        test::MakeRandomValues(static_cast<size_t>(refiner.GetLevel(0).GetNumEdges()), 1);
    std::vector<double> const form(noise.begin(), noise.end());
    auto const apply = [](far_ext::SparseRows const& rows, std::vector<double> const& x) {
        std::vector<double> y(static_cast<size_t>(rows.GetNumRows()));
        rows.Apply(x.data(), y.data(), 1);
        return y;
    };
    auto const around = apply(far_ext::BuildD1(refiner.GetLevel(1)), apply(forms.s1, form));
    auto const across = apply(forms.s2, apply(far_ext::BuildD1(refiner.GetLevel(0)), form));
    double worst = 0.0;
    for (size_t i = 0; i < around.size(); ++i)
        worst = std::max(worst, std::abs(around[i] - across[i]));
    Check(worst < 1e-13, "the stencils commute");
}

void EvaluateByOsd(far_ext::StencilRows const& table, std::vector<float> const& from,
                   std::vector<float>& to, int length) {
    Osd::BufferDescriptor const desc(0, length, length);
    Osd::CpuEvaluator::EvalStencils(from.data(), desc, to.data(), desc, table.GetSizes().data(),
                                    table.GetOffsets().data(), table.GetControlIndices().data(),
                                    table.GetWeights().data(), 0, table.GetNumStencils());
}

void EvaluateBySimd(eval::CompiledStencils const& table, std::vector<float> const& from,
                    std::vector<float>& to, int length) {
    Osd::BufferDescriptor const desc(0, length, length);
    eval::SimdEvaluator::EvalStencils(from.data(), desc, to.data(), desc, table, 0,
                                      table.GetNumStencils());
}

double Run(char const* name, engine::Scene const& scene, int numRounds) {
    auto const refiner = MakeRefiner(scene);
    auto const forms = far_ext::BuildFormStencils(*refiner, 1);
    CheckCommutation(*refiner, forms);
    Index const numEdges = refiner->GetLevel(0).GetNumEdges();
    far_ext::StencilRows const rows = far_ext::MakeStencilRows(forms.s1, numEdges);
    auto const one = eval::CompiledStencils::Compile(rows.GetView(), {.isSliced = true});
    size_t const numFrom = static_cast<size_t>(numEdges),
                 numTo = static_cast<size_t>(rows.GetNumStencils());
    auto const from = test::MakeRandomValues(numFrom, 2),
               fromFour = test::MakeRandomValues(4 * numFrom, 3);
    std::vector<float> ours(numTo), theirs(numTo), oursFour(4 * numTo), theirsFour(4 * numTo);
    EvaluateBySimd(one, from, ours, 1);
    EvaluateByOsd(rows, from, theirs, 1);
    Check(test::RelativeDifference(ours, theirs) < 1e-6, "S1 applied as OpenSubdiv applies it");
    EvaluateBySimd(one, fromFour, oursFour, 4);
    EvaluateByOsd(rows, fromFour, theirsFour, 4);
    Check(test::RelativeDifference(oursFour, theirsFour) < 1e-6, "four forms");
    auto const far = test::MakeFarTable(*refiner, Far::StencilTableFactory::INTERPOLATE_VERTEX);
    double const numOurs = static_cast<double>(forms.s1.weights.size() + forms.s2.weights.size());
    double const numTheirs = static_cast<double>(far->GetWeights().size());

    fmt::print("\n{}: {} edges to {}, {:.1f} entries a row, one thread\n", name, numFrom, numTo,
               static_cast<double>(forms.s1.weights.size()) / static_cast<double>(numTo));
    Rounds rounds(numRounds);
    size_t const build = rounds.Add(
        "limn: S1 and S2 of a level", [&] { far_ext::BuildFormStencils(*refiner, 1); }, numOurs);
    size_t const buildFar = rounds.Add(
        "Far::StencilTableFactory: S0 of it",
        [&] { test::MakeFarTable(*refiner, Far::StencilTableFactory::INTERPOLATE_VERTEX); },
        numTheirs);
    size_t const apply =
        rounds.Add("limn: S1, one form", [&] { EvaluateBySimd(one, from, ours, 1); });
    size_t const applyFour = rounds.Add("limn: S1, four forms at once",
                                        [&] { EvaluateBySimd(one, fromFour, oursFour, 4); });
    size_t const osd = rounds.Add("Osd::CpuEvaluator: S1, length 1",
                                  [&] { EvaluateByOsd(rows, from, theirs, 1); });
    size_t const osdFour = rounds.Add("Osd::CpuEvaluator: S1, length 4",
                                      [&] { EvaluateByOsd(rows, fromFour, theirsFour, 4); });
    rounds.Run("entries");
    double const perEntry =
        (rounds.Get(build).median / numOurs) / (rounds.Get(buildFar).median / numTheirs);
    fmt::print("  => building, time per entry over Far's: {:.2f}, target at most 1: {}\n", perEntry,
               perEntry <= 1.0 ? "reached" : "MISSED");
    rounds.Compare("applying S1 against OpenSubdiv", apply, osd, 8.0);
    rounds.Compare("four forms against OpenSubdiv, length 4", applyFour, osdFour);
    double const batch = rounds.Get(applyFour).median / rounds.Get(apply).median;
    fmt::print("  => four forms over one: {:.2f}, target at most 2: {}\n", batch,
               batch <= 2.0 ? "reached" : "MISSED");
    return rounds.Get(build).best + rounds.Get(apply).best;
}

void RunGrowth(bool isLarge) {
    fmt::print("\nGrowth: building S1 and S2 and applying S1, one thread\n");
    std::vector<double> sizes, times;
    for (int side : {58, 183, 577, 1826}) {
        if (side > 1000 && !isLarge) continue;
        engine::Scene const scene = test::MakeTriangleTorus(side, side);
        auto const refiner = MakeRefiner(scene);
        double const numEdges = refiner->GetLevel(0).GetNumEdges();
        double best = 1e30;
        for (int round = 0; round < 3; ++round) {
            auto const start = std::chrono::steady_clock::now();
            auto const forms = far_ext::BuildFormStencils(*refiner, 1);
            std::vector<double> const form(static_cast<size_t>(numEdges), 1.0);
            std::vector<double> fine(static_cast<size_t>(forms.s1.GetNumRows()));
            forms.s1.Apply(form.data(), fine.data(), 1);
            best = std::min(
                best,
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        }
        sizes.push_back(numEdges);
        times.push_back(best);
        fmt::print("  {:>9} edges: best {:9.2f} ms, {:.1f} ns per edge\n", numEdges, best * 1e3,
                   best / numEdges * 1e9);
    }
    double const exponent = FitExponent(sizes, times);
    fmt::print("  => exponent of time: {:.3f}, target at most 1.05: {}\n", exponent,
               exponent <= 1.05 ? "reached" : "MISSED");
}

}  // namespace
}  // namespace limn::bench

/// --rounds N; --large: growth up to 10 M edges, too (11 GB)
int main(int argc, char** argv) {
    using namespace limn::bench;
    int const numRounds = GetNumRounds(argc, argv);
    OnThreads(1, [&] {
        Run("triangles (Loop)", limn::test::MakeTriangleTorus(288, 288), numRounds);
        Run("quads (Catmull-Clark)", limn::test::MakeTorus(354, 354), numRounds);
        RunGrowth(std::find(argv + 1, argv + argc, std::string_view("--large")) != argv + argc);
    });
}
