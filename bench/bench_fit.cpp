// SPDX-License-Identifier: Apache-2.0
//
// Fitting control points to a mesh's vertices against what there is otherwise: plain iteration
// through OpenSubdiv's evaluator, a sparse Cholesky factorisation, and OpenSubdiv's limit stencils
// for the matrix.

#include <opensubdiv/far/ptexIndices.h>
#include <opensubdiv/far/stencilTableFactory.h>

#include "eval/fit/interpolate.h"
#include "far_ext/limit/limit_matrix.h"
#include "far_ext/topology/refiner.h"
#include "harness.h"
#include "heap_peak.h"
#include "peers/osd_progressive.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"
#ifdef LIMN_HAS_CHOLMOD
#include "peers/cholmod_fit.h"
#endif

namespace limn::bench {
namespace {

struct Case {
    engine::Scene scene;
    std::unique_ptr<Far::TopologyRefiner> refiner;
};

/// Triangles of a torus, a third of their edges flipped, split into quads: valences 3 to 11, 6
/// side^2 vertices, moved by noise of a tenth of the mean edge.
Case MakeIrregularQuads(int side) {
    engine::Scene triangles = test::MakeIrregularTriangles(side, side, 3);
    triangles.cage.scheme = Sdc::SCHEME_CATMARK;
    Case made{test::Refine(triangles, 1), nullptr};
    test::AddNoise(made.scene, 0.1, 1);
    made.refiner = far_ext::CreateRefiner(made.scene.cage);
    return made;
}

double Since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Judge(char const* what, double value, double target, bool isUpperBound) {
    bool const isReached = isUpperBound ? value <= target : value >= target;
    fmt::print("  => {}: {:.3g}, target {}: {}\n", what, value, target,
               isReached ? "reached" : "MISSED");
    std::fflush(stdout);
}

/// OpenSubdiv's limit stencils at the vertices, each at one corner of one of its faces.
void BuildStencilsByOpenSubdiv(far_ext::ControlMesh const& cage) {
    using Factory = Far::LimitStencilTableFactory;
    auto const refiner = far_ext::CreateRefiner(cage);
    refiner->RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(4));
    static float const s[4] = {0, 1, 1, 0}, t[4] = {0, 0, 1, 1};
    std::vector<char> isDone(static_cast<size_t>(cage.numVertices), 0);
    std::vector<Factory::LocationArray> places;
    auto const level = refiner->GetLevel(0);
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        for (int corner = 0; corner < 4; ++corner) {
            char& done = isDone[static_cast<size_t>(level.GetFaceVertices(face)[corner])];
            if (done) continue;
            done = 1;
            Factory::LocationArray place;
            place.ptexIdx = face;
            place.numLocations = 1;
            place.s = s + corner;
            place.t = t + corner;
            places.push_back(place);
        }
    }
    Factory::Options options;
    options.generate1stDerivatives = false;
    std::unique_ptr<Far::LimitStencilTable const> const table(
        Factory::Create(*refiner, places, nullptr, nullptr, options));
    Check(table && table->GetNumStencils() == cage.numVertices, "a limit stencil per vertex");
}

void CheckSolution(Case const& subject, far_ext::LimitMatrix const& A,
                   eval::SolveReport const& report, std::vector<double> const& P) {
    using Rows = Eigen::Map<Eigen::Matrix<double, -1, 3, Eigen::RowMajor> const>;
    Index const count = subject.scene.cage.numVertices;
    double const size = eval::FindSize(subject.scene.positions, 3);
    double const miss =
        (Rows(subject.scene.positions.data(), count, 3) - A.AsMatrix() * Rows(P.data(), count, 3))
            .rowwise()
            .norm()
            .maxCoeff() /
        size;
    Check(report.converged && std::abs(miss - report.residual) < 1e-12,
          "the residual by the explicit matrix");
}

void BenchSolve(int numRounds, bool withCholmod) {
    Case const subject = MakeIrregularQuads(408);
    auto const A = far_ext::LimitMatrix::Build(*subject.refiner);
    eval::Interpolator const interpolator(*subject.refiner);
    auto const& M = subject.scene.positions;
    double const size = eval::FindSize(M, 3);
    std::vector<double> P(M.size());
    auto const report = interpolator.Solve(M, 3, P);
    CheckSolution(subject, A, report, P);
    OsdProgressive peer(A, M);
    int const numPlain = peer.Solve(1e-6 * size);
    for (size_t i = 0; i < P.size(); ++i)
        Check(std::abs(P[i] - static_cast<double>(peer.GetControl()[i])) < 1e-4 * size,
              "both iterations give the same");

    fmt::print(
        "\n{} vertices, irregular quads, residual 1e-6 of the diagonal, one thread; applications "
        "of A: limn {} ({}), plain {}\n",
        subject.scene.cage.numVertices, report.iterations, GetName(report.method), numPlain);
    Judge("applications of A", report.iterations, 20, true);
    double const bytes = 1024.0 * 1024.0 * MeasureHeapPeak([&] {
                             eval::Interpolator(*subject.refiner).Solve(M, 3, P);
                         });
    Judge("bytes per vertex, operator and work", bytes / subject.scene.cage.numVertices, 130, true);

    OnThreads(1, [&] {
        Rounds rounds(numRounds);
        size_t const solve = rounds.Add("limn: solve", [&] { interpolator.Solve(M, 3, P); });
        size_t const both = rounds.Add("limn: operator and solve", [&] {
            eval::Interpolator(*subject.refiner).Solve(M, 3, P);
        });
        size_t const plain = rounds.Add("plain P += M - A P, Osd::CpuEvaluator, length 3",
                                        [&] { peer.Solve(1e-6 * size); });
#ifdef LIMN_HAS_CHOLMOD
        std::vector<double> exact;
        size_t const cholmod =
            withCholmod ? rounds.Add("CHOLMOD", [&] { exact = SolveByCholmod(A, M); }) : 0;
#else
        fmt::print("  CHOLMOD was not there when this was built (libsuitesparse-dev); skipped\n");
#endif
        rounds.Run("vertices");
        rounds.Compare("solve against plain iteration through OpenSubdiv", solve, plain, 15.0);
        rounds.Compare("operator and solve against plain iteration alone", both, plain);
#ifdef LIMN_HAS_CHOLMOD
        if (!withCholmod) return;
        rounds.Compare("solve against CHOLMOD", solve, cholmod, 60.0);
        rounds.Compare("operator and solve against CHOLMOD", both, cholmod);
        for (size_t i = 0; i < P.size(); ++i)
            Check(std::abs(P[i] - exact[i]) < 2e-5 * size, "CHOLMOD gives the same");
#endif
    });
}

/// Seconds per vertex of building A, on a sample that OpenSubdiv's stencils can be waited for.
void BenchBuild(int numRounds) {
    Case const large = MakeIrregularQuads(408), sample = MakeIrregularQuads(30);
    Rounds rounds(numRounds);
    size_t const matrix = rounds.Add("LimitMatrix, 1 M vertices",
                                     [&] { far_ext::LimitMatrix::Build(*large.refiner); });
    size_t const index = rounds.Add("LimitOperator (without weights), 1 M vertices",
                                    [&] { eval::LimitOperator::Build(*large.refiner); });
    size_t const theirs = rounds.Add("Far::LimitStencilTableFactory, 5400 vertices",
                                     [&] { BuildStencilsByOpenSubdiv(sample.scene.cage); });
    fmt::print("\nBuilding A\n");
    rounds.Run();
    double const perVertex = rounds.Get(theirs).median / sample.scene.cage.numVertices;
    double const scale = large.scene.cage.numVertices;
    Judge("LimitMatrix against limit stencils, per vertex, times faster",
          perVertex / (rounds.Get(matrix).median / scale), 100, false);
    Judge("LimitOperator against limit stencils, per vertex, times faster",
          perVertex / (rounds.Get(index).median / scale), 100, false);
}

void BenchGrowth(int numRounds, bool isLarge) {
    std::vector<double> sizes, times, bytes;
    fmt::print("\nGrowth: operator and solve, one thread\n");
    for (int side : {41, 129, 408, 1291}) {
        if (side > 1000 && !isLarge) continue;
        Case const subject = MakeIrregularQuads(side);
        std::vector<double> P(subject.scene.positions.size());
        auto const run = [&] {
            eval::Interpolator(*subject.refiner).Solve(subject.scene.positions, 3, P);
        };
        double best = 1e30;
        OnThreads(1, [&] {
            for (int round = 0; round < numRounds + 1; ++round) {
                auto const start = std::chrono::steady_clock::now();
                run();
                best = std::min(best, Since(start));
            }
        });
        double const count = subject.scene.cage.numVertices;
        bytes.push_back(1024.0 * 1024.0 * MeasureHeapPeak(run));
        sizes.push_back(count);
        times.push_back(best);
        fmt::print("  {:>9} vertices: best {:9.2f} ms, {:6.1f} ns and {:5.1f} bytes per vertex\n",
                   count, best * 1e3, best / count * 1e9, bytes.back() / count);
        std::fflush(stdout);
    }
    Judge("exponent of time", FitExponent(sizes, times), 1.05, true);
    Judge("exponent of memory", FitExponent(sizes, bytes), 1.05, true);
}

}  // namespace
}  // namespace limn::bench

/// --rounds N, --no-cholmod (it takes 10 s a round), --large (10 M vertices, too: 6 GB)
int main(int argc, char** argv) {
    using namespace limn::bench;
    auto const has = [&](std::string_view option) {
        return std::find(argv + 1, argv + argc, option) != argv + argc;
    };
    int const numRounds = std::min(GetNumRounds(argc, argv), 3);
    BenchSolve(numRounds, !has("--no-cholmod"));
    BenchBuild(numRounds);
    BenchGrowth(numRounds, has("--large"));
}
