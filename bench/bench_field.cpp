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

void Run(int numRounds) {
    engine::Scene const scene = test::MakeTriangleTorus(450, 450);
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const level = refiner->GetLevel(0);
    std::vector<double> rho(static_cast<size_t>(level.GetNumVertices()), 0.0),
        kappa(static_cast<size_t>(level.GetNumFaces()), 0.0);
    rho[1] = kappa[1] = 1.0;
    rho[rho.size() / 2] = kappa[kappa.size() / 2] = -1.0;
    double const size = static_cast<double>(level.GetNumVertices());
    fmt::print("{} vertices, {} faces, one thread\n", level.GetNumVertices(), level.GetNumFaces());

    auto const design = [&] {
        return std::make_unique<eval::FieldDesigner>(level, scene.positions,
                                                     eval::AtBoundary::Tangent);
    };
    auto const designer = design();
    auto const gradient = designer->MakeGradient(rho), vortex = designer->MakeVortex(kappa);
    auto const inflow = designer->FindInflow(gradient), curl = designer->FindCurl(vortex);
    for (size_t i = 0; i < rho.size(); ++i)
        Check(std::abs(inflow[i] + rho[i]) < 1e-10, "the flow asked for");
    for (size_t i = 0; i < kappa.size(); ++i)
        Check(std::abs(curl[i] - kappa[i]) < 1e-10, "the circulation asked for");

    PeerProblem const problem(level, designer->GetStars().edge, rho);
    Eigen::VectorXd x;
    Rounds rounds(numRounds);
    size_t const sources =
        rounds.Add("limn, sources from nothing", [&] { design()->MakeGradient(rho); }, size);
    size_t const vortices =
        rounds.Add("limn, vortices from nothing", [&] { design()->MakeVortex(kappa); }, 2.0 * size);
    size_t const again =
        rounds.Add("limn, sources of other strengths", [&] { designer->MakeGradient(rho); }, size);
    size_t const vorticesAgain = rounds.Add(
        "limn, vortices of other strengths", [&] { designer->MakeVortex(kappa); }, 2.0 * size);
    auto const solveByAmd = [&] {
        x = Eigen::SimplicialLLT<Matrix>(problem.matrix).solve(problem.right);
    };
    solveByAmd();
    problem.CheckAnswer(x, "minimum degree");
    size_t const amd = rounds.Add("Eigen, minimum degree, sources", solveByAmd, size);
#ifdef LIMN_HAS_CHOLMOD
    auto const solveByCholmod = [&] {
        x = Eigen::CholmodSupernodalLLT<Matrix>(problem.matrix).solve(problem.right);
    };
    solveByCholmod();
    problem.CheckAnswer(x, "CHOLMOD");
    size_t const cholmod = rounds.Add("CHOLMOD, supernodal, sources", solveByCholmod, size);
#endif
    rounds.Run("unknowns");
    rounds.Compare("against minimum degree", sources, amd);
#ifdef LIMN_HAS_CHOLMOD
    rounds.Compare("against CHOLMOD", sources, cholmod);
#endif
    auto const report = [&](char const* what, size_t variant, double target) {
        double const seconds = rounds.Get(variant).median;
        fmt::print("  => {}: {:.3f} s, target at most {} s: {}\n", what, seconds, target,
                   seconds <= target ? "reached" : "MISSED");
    };
    report("sources from nothing", sources, 5.0);
    report("vortices from nothing", vortices, 5.0);
    report("sources of other strengths", again, 0.2);
    report("vortices of other strengths", vorticesAgain, 0.2);
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
    int const numRounds = limn::bench::GetNumRounds(argc, argv);
    limn::bench::OnThreads(1, [&] { limn::bench::Run(numRounds); });
}
