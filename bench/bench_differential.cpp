// SPDX-License-Identifier: Apache-2.0
//
// Reconstruction from differential coordinates: how iterations, time and memory grow, and how it
// compares with a sparse factorisation and with algebraic multigrid. Set-up and solve, 3 right-hand
// sides, residual 1e-8, from zero.

#include "engine/differential/differential.h"
#include "engine/scene/refine.h"
#include "eval/differential/reconstruct.h"
#include "eval/differential/subdivide_values.h"
#include "far_ext/differential/laplacian.h"
#include "harness.h"
#include "support/refined.h"
#ifdef LIMN_HAS_CHOLMOD
#include "peers/cholmod_laplacian.h"
#endif
#ifdef LIMN_HAS_HYPRE
#include "peers/hypre_laplacian.h"
#endif

namespace limn::bench {
namespace {

constexpr double kTolerance = 1e-8;

/// A closed cage, refined, with its scaled differential coordinates on the last level.
struct Problem {
    std::string name;
    std::unique_ptr<Far::TopologyRefiner> refiner;
    std::vector<double> deltas;

    Problem(std::string what, engine::Scene const& scene, int levels)
        : name(std::move(what)), refiner(test::MakeRefiner(scene, levels)) {
        deltas = test::Apply(far_ext::BuildCombinatorialLaplacian(refiner->GetLevel(0)),
                             scene.positions);
        for (int level = 1; level <= levels; ++level) {
            deltas = eval::RefineValues<3>(*refiner, level, deltas);
            for (double& delta : deltas) delta *= 0.25;
        }
    }

    double GetSize() const { return static_cast<double>(deltas.size()) / 3.0; }

    eval::ReconstructReport Solve(std::vector<double>& positions) const {
        positions.assign(deltas.size(), 0.0);
        return eval::Reconstructor(*refiner).Solve(deltas, positions, {.tolerance = kTolerance});
    }
};

/// Iterations, exponent and bytes over sizes of one kind of mesh.
void MeasureGrowth(char const* what, int mostIterations, int numRounds,
                   std::vector<std::pair<engine::Scene, int>> const& cases) {
    fmt::print("\n{}, one thread\n", what);
    std::vector<double> sizes, seconds;
    int worst = 0;
    double mostBytes = 0.0;
    for (auto const& [scene, levels] : cases) {
        Problem const problem(what, scene, levels);
        std::vector<double> positions;
        auto const report = problem.Solve(positions);
        Check(report.converged && report.residual < 2.0 * kTolerance,
              "the solver did not converge");
        worst = std::max(worst, report.iterations);
        double const bytes =
            static_cast<double>(
                eval::Reconstructor(*problem.refiner).GetMultigrid().GetNumBytes()) /
                problem.GetSize() +
            24.0;
        mostBytes = std::max(mostBytes, bytes);
        fmt::print("{:.0f} unknowns: {} iterations, residual {:.1e}, {:.0f} bytes per unknown\n",
                   problem.GetSize(), report.iterations, report.residual, bytes);
        Rounds rounds(numRounds);
        size_t const number =
            rounds.Add("set-up and solve", [&] { problem.Solve(positions); }, problem.GetSize());
        eval::Reconstructor again(*problem.refiner);
        size_t const solve = rounds.Add("solve alone (a re-edit)", [&] {
            positions.assign(problem.deltas.size(), 0.0);
            again.Solve(problem.deltas, positions, {.tolerance = kTolerance});
        });
        rounds.Run("unknowns");
        sizes.push_back(problem.GetSize());
        seconds.push_back(rounds.Get(number).processor);
        fmt::print("  => a re-edit takes {:.2f} of set-up and solve\n",
                   rounds.Get(solve).processor / rounds.Get(number).processor);
    }
    double const exponent = FitExponent(sizes, seconds);
    auto const verdict = [](bool isReached) { return isReached ? "reached" : "MISSED"; };
    fmt::print("  => {}: at most {} iterations, target {}: {}\n", what, worst, mostIterations,
               verdict(worst <= mostIterations));
    fmt::print("  => exponent of processor time {:.3f}, target at most 1.1: {}\n", exponent,
               verdict(exponent <= 1.1));
    fmt::print("  => at most {:.0f} bytes per unknown, target 350: {}\n", mostBytes,
               verdict(mostBytes <= 350));
}

#if defined(LIMN_HAS_CHOLMOD) || defined(LIMN_HAS_HYPRE)
/// The problem's right-hand side as its whole matrix takes it: degree times delta, projected.
std::vector<double> MakeRightSide(Problem const& problem, std::vector<double> const& positions) {
    auto const level = problem.refiner->GetLevel(problem.refiner->GetMaxLevel());
    auto rightSide = test::Apply(far_ext::BuildCombinatorialLaplacian(level), positions);
    for (size_t i = 0; i < rightSide.size(); ++i)
        rightSide[i] *= level.GetVertexEdges(static_cast<Index>(i / 3)).size();
    return rightSide;
}

void ComparePeers(int numRounds, engine::Scene const& scene, int levels,
                  [[maybe_unused]] std::optional<double> cholmodTarget,
                  [[maybe_unused]] std::optional<double> hypreTarget) {
    Problem const problem("torus", scene, levels);
    fmt::print("\n{:.0f} unknowns, one thread\n", problem.GetSize());
    std::vector<double> positions;
    problem.Solve(positions);
    PinnedLaplacian const pinned(
        eval::BuildMultigridLevels(*problem.refiner, eval::FixedVertices::None, levels).back(),
        MakeRightSide(problem, positions));
    Rounds rounds(numRounds);
    size_t const ours =
        rounds.Add("limn, set-up and solve", [&] { problem.Solve(positions); }, problem.GetSize());
    Eigen::MatrixX3d x;
#ifdef LIMN_HAS_CHOLMOD
    Check(pinned.FindResidual(SolveByCholmod(pinned)) < 1e-7, "CHOLMOD's residual");
    size_t const cholmod = rounds.Add(
        "CHOLMOD, supernodal, METIS", [&] { x = SolveByCholmod(pinned); }, problem.GetSize());
#endif
#ifdef LIMN_HAS_HYPRE
    HypreLaplacian const hypre(pinned);
    Check(pinned.FindResidual(hypre.Solve(kTolerance)) < 1e-7, "hypre's residual");
    size_t const boomer =
        rounds.Add("hypre, BoomerAMG-PCG", [&] { x = hypre.Solve(kTolerance); }, problem.GetSize());
#endif
    rounds.Run("unknowns");
#ifdef LIMN_HAS_CHOLMOD
    rounds.Compare("against CHOLMOD", ours, cholmod, cholmodTarget);
#endif
#ifdef LIMN_HAS_HYPRE
    rounds.Compare("against BoomerAMG", ours, boomer, hypreTarget);
#endif
}
#endif

/// The whole of limn refine --space differential but reading and writing, against its solve.
void MeasureWhole(int numRounds, engine::Scene const& scene, int levels) {
    Rounds rounds(numRounds);
    auto const model = engine::Model::Build(scene);
    engine::Job job;
    std::vector<double> shares;
    engine::DifferentialReport report;
    rounds.Add("limn refine --space differential", [&] {
        auto const start = std::chrono::steady_clock::now();
        report = engine::RefineDifferentially(model, {.levels = levels}, job).report;
        std::chrono::duration<double> const elapsed = std::chrono::steady_clock::now() - start;
        shares.push_back(elapsed.count() / report.seconds.reconstruction);
    });
    fmt::print("\nThe whole refinement\n");
    rounds.Run();
    std::sort(shares.begin(), shares.end());
    double const share = shares[shares.size() / 2];
    fmt::print("  => {} unknowns: {:.2f} times its solve, target at most 2: {}\n", report.unknowns,
               share, share <= 2.0 ? "reached" : "MISSED");
}

void Run(int numRounds) {
    OnThreads(1, [&] {
        std::vector<std::pair<engine::Scene, int>> regular, irregular;
        for (auto const& [side, levels] : {std::pair{36, 2}, {36, 3}, {36, 4}, {62, 4}, {63, 5}})
            regular.emplace_back(test::MakeTriangleTorus(side, side), levels);
        engine::Scene const cage = test::LoadAsset("tri/eight.off");
        for (int levels : {3, 4, 5, 6, 7}) irregular.emplace_back(cage, levels);
        for (auto& [scene, levels] : irregular) scene.cage.scheme = Sdc::SCHEME_LOOP;
        MeasureGrowth("Regular triangles (torus)", 10, numRounds, regular);
        MeasureGrowth("Irregular triangles", 14, numRounds, irregular);
        MeasureWhole(numRounds, irregular[2].first, 5);
#if defined(LIMN_HAS_CHOLMOD) || defined(LIMN_HAS_HYPRE)
        ComparePeers(numRounds, regular[0].first, 2, {}, {});
        ComparePeers(std::min(numRounds, 3), regular[3].first, 4, 13.0, 5.0);  // minutes otherwise
#endif
    });
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
    limn::bench::Run(limn::bench::GetNumRounds(argc, argv));
    return 0;
}
