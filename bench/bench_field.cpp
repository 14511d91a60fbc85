// SPDX-License-Identifier: Apache-2.0
//
// Design of tangent fields on control meshes, which have no hierarchy: sources and vortices from
// nothing, and again for other strengths, next to other factorisations of the same equations.

#include <Eigen/SparseCholesky>

#include "eval/forms/field_designer.h"
#include "far_ext/topology/refiner.h"
#include "harness.h"
#include "support/meshes.h"
#ifdef LIMN_HAS_CHOLMOD
#include <Eigen/CholmodSupport>
#endif

namespace limn::bench {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// d0^T *1 d0 without its first row: what the peers factorise.
struct PeerProblem {
    Matrix matrix;
    Eigen::VectorXd right;

    PeerProblem(Far::TopologyLevel const& level, std::vector<double> const& stars,
                std::vector<double> const& rho)
        : matrix(level.GetNumVertices() - 1, level.GetNumVertices() - 1),
          right(Eigen::VectorXd::Map(rho.data() + 1, level.GetNumVertices() - 1)) {
        std::vector<Eigen::Triplet<double>> entries;
        for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
            auto const ends = level.GetEdgeVertices(edge);
            Index const a = std::min(ends[0], ends[1]), b = std::max(ends[0], ends[1]);
            double const weight = stars[edge];
            if (a > 0) entries.emplace_back(a - 1, a - 1, weight);
            entries.emplace_back(b - 1, b - 1, weight);
            if (a > 0)
                entries.insert(entries.end(), {{a - 1, b - 1, -weight}, {b - 1, a - 1, -weight}});
        }
        matrix.setFromTriplets(entries.begin(), entries.end());
    }

    void CheckAnswer(Eigen::VectorXd const& x, char const* who) const {
        Check((matrix * x - right).norm() < 1e-9 * right.norm(), std::string(who) + ": residual");
    }
};

/// A torus of triangles with one source and one sink, one vortex and its opposite.
struct Problem {
    engine::Scene scene = test::MakeTriangleTorus(450, 450);
    std::unique_ptr<Far::TopologyRefiner> refiner = far_ext::CreateRefiner(scene.cage);
    Far::TopologyLevel level = refiner->GetLevel(0);
    std::vector<double> rho, kappa;

    Problem()
        : rho(static_cast<size_t>(level.GetNumVertices()), 0.0),
          kappa(static_cast<size_t>(level.GetNumFaces()), 0.0) {
        rho[1] = kappa[1] = 1.0;
        rho[rho.size() / 2] = kappa[kappa.size() / 2] = -1.0;
    }

    double GetSize() const { return static_cast<double>(level.GetNumVertices()); }

    eval::FieldDesigner MakeDesigner() const {
        return {level, scene.positions, eval::AtBoundary::Tangent};
    }
};

void CheckResults(Problem const& problem, eval::FieldDesigner& designer) {
    std::vector<double> const &rho = problem.rho, &kappa = problem.kappa;
    auto const gradient = designer.MakeGradient(rho), vortex = designer.MakeVortex(kappa);
    auto const inflow = designer.FindInflow(gradient), curl = designer.FindCurl(vortex);
    for (size_t i = 0; i < rho.size(); ++i)
        Check(std::abs(inflow[i] + rho[i]) < 1e-10, "the flow asked for");
    for (size_t i = 0; i < kappa.size(); ++i)
        Check(std::abs(curl[i] - kappa[i]) < 1e-10, "the circulation asked for");
}

/// Adds another factorisation of the equations of the sources. \return  the variant's number
template <class Solver>
size_t AddPeer(char const* name, PeerProblem const& problem, Rounds& rounds) {
    auto const solve = [&problem]() -> Eigen::VectorXd {
        return Solver(problem.matrix).solve(problem.right);
    };
    problem.CheckAnswer(solve(), name);
    return rounds.Add(name, solve, static_cast<double>(problem.right.size() + 1));
}

void Report(Rounds const& rounds, char const* what, size_t variant, double target) {
    double const seconds = rounds.Get(variant).median;
    fmt::print("  => {}: {:.3f} s, target at most {} s: {}\n", what, seconds, target,
               seconds <= target ? "reached" : "MISSED");
}

void Run(int numRounds) {
    Problem const problem;
    double const size = problem.GetSize();
    fmt::print("{} vertices, {} faces, one thread\n", problem.level.GetNumVertices(),
               problem.level.GetNumFaces());
    auto designer = problem.MakeDesigner();
    CheckResults(problem, designer);

    PeerProblem const peers(problem.level, designer.GetStars().edge, problem.rho);
    Rounds rounds(numRounds);
    auto const add = [&](char const* name, double items, auto const& work) {
        return rounds.Add(name, work, items);
    };
    size_t const sources = add("limn, sources from nothing", size,
                               [&] { problem.MakeDesigner().MakeGradient(problem.rho); });
    size_t const vortices = add("limn, vortices from nothing", 2.0 * size,
                                [&] { problem.MakeDesigner().MakeVortex(problem.kappa); });
    size_t const again =
        add("limn, sources of other strengths", size, [&] { designer.MakeGradient(problem.rho); });
    size_t const vorticesAgain = add("limn, vortices of other strengths", 2.0 * size,
                                     [&] { designer.MakeVortex(problem.kappa); });
    size_t const amd =
        AddPeer<Eigen::SimplicialLLT<Matrix>>("Eigen, minimum degree, sources", peers, rounds);
#ifdef LIMN_HAS_CHOLMOD
    size_t const cholmod =
        AddPeer<Eigen::CholmodSupernodalLLT<Matrix>>("CHOLMOD, supernodal, sources", peers, rounds);
#endif
    rounds.Run("unknowns");
    rounds.Compare("against minimum degree", sources, amd);
#ifdef LIMN_HAS_CHOLMOD
    rounds.Compare("against CHOLMOD", sources, cholmod);
#endif
    Report(rounds, "sources from nothing", sources, 5.0);
    Report(rounds, "vortices from nothing", vortices, 5.0);
    Report(rounds, "sources of other strengths", again, 0.2);
    Report(rounds, "vortices of other strengths", vorticesAgain, 0.2);
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
    int const numRounds = limn::bench::GetNumRounds(argc, argv);
    limn::bench::OnThreads(1, [&] { limn::bench::Run(numRounds); });
}
