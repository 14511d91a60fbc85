// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/area_fit.h"

#include <gtest/gtest.h>
#include <unsupported/Eigen/LevenbergMarquardt>
#include <unsupported/Eigen/NumericalDiff>

#include "eval/differential/reconstruct.h"
#include "support/area_laplacians.h"
#include "support/fit_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using eval::AreaLaplacianKind;

class FitOf : public testing::TestWithParam<AreaLaplacianKind> {};
INSTANTIATE_TEST_SUITE_P(Laplacians, FitOf,
                         testing::Values(AreaLaplacianKind::Cotangent, AreaLaplacianKind::Heat));

/// The same least squares for Eigen's Levenberg and Marquardt, of closed meshes: positions in,
/// sqrt(area) (Delta - M L V) out, derivatives by differences.
struct Residuals : Eigen::DenseFunctor<double> {
    Far::TopologyLevel level;
    AreaLaplacianKind kind;
    std::vector<double> const &deltas, &areas;

    Residuals(Far::TopologyLevel const& of, AreaLaplacianKind which,
              std::vector<double> const& wanted, std::vector<double> const& weights)
        : DenseFunctor(static_cast<int>(wanted.size()), static_cast<int>(wanted.size())),
          level(of),
          kind(which),
          deltas(wanted),
          areas(weights) {}

    int operator()(Eigen::VectorXd const& x, Eigen::VectorXd& values) const {
        std::span<double const> const positions(x.data(), deltas.size());
        auto const laplacian = test::BuildLaplacian(kind, level, positions);
        auto const images = far_ext::FindDeltas(laplacian.rows, positions);
        for (size_t i = 0; i < deltas.size(); ++i) {
            values[static_cast<Index>(i)] =
                std::sqrt(areas[i / 3]) * (deltas[i] - images[i] / laplacian.areas[i / 3]);
        }
        return 0;
    }
};

/// A bumpy closed mesh in differential space: coordinates that no mesh has, and where a fit begins.
struct Problem {
    std::unique_ptr<Far::TopologyRefiner> refiner;
    std::vector<double> deltas, start, areas;
    AreaLaplacianKind kind;

    Problem(engine::Scene scene, int levels, AreaLaplacianKind which) : kind(which) {
        for (size_t i = 0; i < scene.positions.size(); ++i)
            scene.positions[i] *= 1.0 + 0.1 * std::sin(static_cast<double>(i / 3));
        refiner = test::MakeRefiner(scene, levels);
        auto const base = refiner->GetLevel(0);
        auto const laplacian = test::BuildLaplacian(kind, base, scene.positions);
        deltas = far_ext::FindDeltas(laplacian.rows, scene.positions);
        for (size_t i = 0; i < deltas.size(); ++i) deltas[i] /= laplacian.areas[i / 3];
        auto uniform =
            far_ext::FindDeltas(far_ext::BuildCombinatorialLaplacian(base), scene.positions);
        start = scene.positions;
        for (int level = 1; level <= levels; ++level) {
            deltas = eval::RefineValues<3>(*refiner, level, deltas);
            uniform = eval::RefineValues<3>(*refiner, level, uniform);
            start = eval::RefineValues<3>(*refiner, level, start);
            for (double& delta : uniform) delta *= 0.25;
        }
        eval::Reconstructor(*refiner).Solve(uniform, start);
        areas = far_ext::FindVertexAreas(refiner->GetLevel(levels), start);
    }

    Residuals GetResiduals() const {
        return {refiner->GetLevel(refiner->GetMaxLevel()), kind, deltas, areas};
    }

    double FindResidual(double squares) const {
        double scale = 0.0;
        for (size_t i = 0; i < deltas.size(); ++i) scale += areas[i / 3] * deltas[i] * deltas[i];
        return std::sqrt(squares / scale);
    }

    /// The residual of positions.
    double Measure(std::vector<double> const& positions) const {
        auto const residuals = GetResiduals();
        Eigen::VectorXd values(residuals.values());
        residuals(Eigen::Map<Eigen::VectorXd const>(positions.data(), residuals.inputs()), values);
        return FindResidual(values.squaredNorm());
    }

    /// The residual that Eigen's solver reaches in so many steps.
    double MinimiseByEigen(int numSteps) const {
        Eigen::NumericalDiff<Residuals> residuals(GetResiduals());
        Eigen::LevenbergMarquardt<Eigen::NumericalDiff<Residuals>> solver(residuals);
        solver.setMaxfev(numSteps * (residuals.inputs() + 2));  // differences count
        Eigen::VectorXd x = Eigen::Map<Eigen::VectorXd const>(start.data(), residuals.inputs());
        solver.minimize(x);
        return FindResidual(solver.fvec().squaredNorm());
    }
};

// An independent solver, with exact steps and derivatives by differences, from the same start:
// there are many minima near each other, and which one a solver ends in is chance.
TEST_P(FitOf, AGeneralSolverReachesNothingMuchLower) {
    for (auto const& scene : {test::LoadDifferential("icosa", Sdc::SCHEME_LOOP),
                              test::MakeTriangleTorus(5, 4), test::MakeBipyramid(5)}) {
        Problem const problem(scene, 1, GetParam());
        eval::Multigrid multigrid(*problem.refiner, eval::FixedVertices::Boundary);
        auto positions = problem.start;
        auto const report = eval::FitAreaLaplacian(*problem.refiner, multigrid, GetParam(),
                                                   problem.deltas, positions, {.tolerance = 1e-8});
        EXPECT_FALSE(report.converged);
        EXPECT_TRUE(report.hasStalled);
        EXPECT_NEAR(report.residual, problem.Measure(positions), 1e-6 * report.residual);
        EXPECT_LT(report.residual, 1.6 * problem.MinimiseByEigen(30));
    }
}

/// Fits the coordinates that a smooth shape itself has, from that shape with its points disturbed.
struct Recovery {
    double before, after;
    eval::AreaFitReport report;
    std::vector<double> positions;

    Recovery(int levels, AreaLaplacianKind kind) {
        auto const scene = test::LoadDifferential("icosa", Sdc::SCHEME_LOOP);
        auto const refiner = test::MakeRefiner(scene, levels);
        auto truth = test::SubdivideToSphere(*refiner, scene.positions);
        for (size_t i = 0; i < truth.size(); i += 3) truth[i] *= 1.3;  // an ellipsoid
        auto const level = refiner->GetLevel(levels);
        auto const laplacian = test::BuildLaplacian(kind, level, truth);
        auto deltas = test::Apply(laplacian.rows, truth);
        for (size_t i = 0; i < deltas.size(); ++i) deltas[i] /= laplacian.areas[i / 3];
        positions = truth;
        for (size_t i = 0; i < positions.size(); ++i)
            positions[i] *= 1.0 + 0.02 * std::sin(truth[i - i % 3] + truth[i - i % 3 + 1]);
        before = test::LargestDifference(positions, truth, true);
        eval::Multigrid multigrid(*refiner, eval::FixedVertices::Boundary);
        report = eval::FitAreaLaplacian(*refiner, multigrid, kind, deltas, positions);
        after = test::LargestDifference(positions, truth, true);
    }
};

TEST(AreaFit, CotangentCoordinatesGiveTheirShapeBack) {
    Recovery const recovery(3, AreaLaplacianKind::Cotangent);
    EXPECT_TRUE(recovery.report.converged);
    EXPECT_LT(recovery.report.residual, 0.01 * recovery.report.initialResidual);
    EXPECT_LT(recovery.after, 0.1 * recovery.before);
}

TEST(AreaFit, HeatCoordinatesGiveTheirShapeBack) {
    Recovery const recovery(2, AreaLaplacianKind::Heat);
    EXPECT_LT(recovery.report.residual, 0.01 * recovery.report.initialResidual);
    EXPECT_LT(recovery.after, 0.1 * recovery.before);
}

}  // namespace
}  // namespace limn
