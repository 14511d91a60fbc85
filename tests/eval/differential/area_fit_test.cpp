// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/area_fit.h"

#include <gtest/gtest.h>

#include "support/refined.h"

namespace limn {
namespace {

/// Fits the coordinates that a smooth shape itself has, from that shape with its points disturbed.
struct Recovery {
    double before, after;
    eval::AreaFitReport report;
    std::vector<double> positions;

    Recovery(int levels, auto const& buildFor) {
        auto const scene = test::LoadDifferential("icosa", Sdc::SCHEME_LOOP);
        auto const refiner = test::MakeRefiner(scene, levels);
        auto truth = test::SubdivideToSphere(*refiner, scene.positions);
        for (size_t i = 0; i < truth.size(); i += 3) truth[i] *= 1.3;  // an ellipsoid
        eval::LaplacianBuilder const build = buildFor(refiner->GetLevel(levels));
        auto const laplacian = build(truth);
        auto deltas = test::Apply(laplacian.rows, truth);
        for (size_t i = 0; i < deltas.size(); ++i) deltas[i] /= laplacian.areas[i / 3];
        positions = truth;
        for (size_t i = 0; i < positions.size(); ++i)
            positions[i] *= 1.0 + 0.02 * std::sin(truth[i - i % 3] + truth[i - i % 3 + 1]);
        before = test::LargestDifference(positions, truth, true);
        eval::Multigrid multigrid(*refiner, eval::FixedVertices::Boundary);
        report = eval::FitAreaLaplacian(*refiner, multigrid, build, deltas, positions);
        after = test::LargestDifference(positions, truth, true);
    }
};

TEST(AreaFit, CotangentCoordinatesGiveTheirShapeBack) {
    Recovery const recovery(3, [](Far::TopologyLevel const& level) {
        return [level](std::span<double const> p) {
            return far_ext::BuildCotangentLaplacian(level, p);
        };
    });
    EXPECT_TRUE(recovery.report.converged);
    EXPECT_LT(recovery.report.residual, 0.01 * recovery.report.initialResidual);
    EXPECT_LT(recovery.after, 0.1 * recovery.before);
}

TEST(AreaFit, HeatCoordinatesGiveTheirShapeBack) {
    Recovery const recovery(2, [](Far::TopologyLevel const& level) {
        return [level](std::span<double const> p) { return far_ext::BuildHeatLaplacian(level, p); };
    });
    EXPECT_LT(recovery.report.residual, 0.01 * recovery.report.initialResidual);
    EXPECT_LT(recovery.after, 0.1 * recovery.before);
}

}  // namespace
}  // namespace limn
