// SPDX-License-Identifier: Apache-2.0
//
// What digits allow: far from the origin, on meshes whose equations rounding makes unsolvable, at
// deep levels.

#include <cmath>

#include <gtest/gtest.h>

#include "eval/differential/reconstruct.h"
#include "eval/differential/subdivide_values.h"
#include "far_ext/differential/laplacian.h"
#include "support/fit_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

constexpr double kTolerance = 1e-12;

struct Reconstruction {
    std::unique_ptr<Far::TopologyRefiner> refiner;
    std::vector<double> deltas, positions;
    eval::ReconstructReport report;

    Reconstruction(engine::Scene const& scene, int levels)
        : refiner(test::MakeRefiner(scene, levels)), positions(scene.positions) {
        deltas = far_ext::FindDeltas(far_ext::BuildCombinatorialLaplacian(refiner->GetLevel(0)),
                                     positions);
        for (int level = 1; level <= levels; ++level) {
            deltas = eval::RefineValues<3>(*refiner, level, deltas);
            positions = eval::RefineValues<3>(*refiner, level, positions);
            for (double& delta : deltas) delta *= 0.25;
        }
        report = eval::Reconstructor(*refiner).Solve(deltas, positions, {.tolerance = kTolerance});
    }
};

/// A scene moved along all axes, with coordinates that stay exact: multiples of 2^-20.
engine::Scene Move(engine::Scene scene, double offset) {
    for (double& x : scene.positions)
        x = std::round(x * 0x1p20) / 0x1p20 + std::round(offset * 0x1p20) / 0x1p20;
    return scene;
}

std::vector<engine::Scene> ClosedAndOpenMeshes() {
    return {test::MakeTriangleTorus(8, 6), test::MakeTorus(7, 5), test::MakeBipyramid(7),
            test::MakeFan(6, Sdc::SCHEME_LOOP, 0.1, 0.05),
            test::LoadDifferential("gridholetri", Sdc::SCHEME_LOOP)};
}

// The digits that coordinates lose by their size are all that a translation costs.
TEST(ReconstructAccuracy, AMovedMeshGivesTheMovedResult) {
    for (auto const& scene : ClosedAndOpenMeshes()) {
        double const diagonal = test::BoxDiagonal(scene.positions);
        Reconstruction const here(Move(scene, 0.0), 3);
        for (double diagonals : {10.0, 125.0, 1e4}) {
            double const offset = std::round(diagonals * diagonal * 0x1p20) / 0x1p20;
            Reconstruction const there(Move(scene, offset), 3);
            EXPECT_TRUE(there.report.converged);
            EXPECT_EQ(there.report.iterations, here.report.iterations);
            auto moved = here.positions;
            for (double& x : moved) x += offset;
            // A handle's place comes through three levels of subdivision, the rest is one sum.
            EXPECT_LT(test::LargestDifference(there.positions, moved),
                      0x1p-53 * 8.0 * (offset + diagonal) + 1e-12 * diagonal)
                << scene.cage.numVertices << " vertices, " << diagonals << " diagonals off";
        }
    }
}

/// |d (Delta - L V)| / |d Delta| over vertices inside, d Delta projected onto what a mesh can have;
/// of a mesh of one component.
double MeasureResidual(Reconstruction const& found) {
    auto const level = found.refiner->GetLevel(found.refiner->GetMaxLevel());
    bool isClosed = true;
    for (Index v = 0; v < level.GetNumVertices(); ++v) isClosed &= !level.IsVertexBoundary(v);
    auto const image =
        far_ext::FindDeltas(far_ext::BuildCombinatorialLaplacian(level), found.positions);
    double residual = 0.0, size = 0.0;
    for (size_t c = 0; c < 3; ++c) {
        double sum = 0.0, squares = 0.0;
        for (Index v = 0; v < level.GetNumVertices(); ++v) {
            double const degree = level.GetVertexEdges(v).size();
            sum += degree * found.deltas[3 * static_cast<size_t>(v) + c];
            squares += degree * degree;
        }
        for (Index v = 0; v < level.GetNumVertices(); ++v) {
            if (level.IsVertexBoundary(v)) continue;
            size_t const at = 3 * static_cast<size_t>(v) + c;
            double const degree = level.GetVertexEdges(v).size(),
                         share = isClosed ? degree * degree * sum / squares : 0.0,
                         wanted = degree * found.deltas[at] - share;
            residual += std::pow(wanted - degree * image[at], 2);
            size += std::pow(wanted, 2);
        }
    }
    return std::sqrt(residual / size);
}

// Reported is what the positions handed back have, far from the origin, too, where their last
// digits are most of it; it is as small as asked, but for these digits.
TEST(ReconstructAccuracy, TheResidualIsThatOfTheResult) {
    for (auto const& scene : ClosedAndOpenMeshes()) {
        for (double offset : {0.0, 300.0, 3e4}) {
            Reconstruction const found(Move(scene, offset), 4);
            double const measured = MeasureResidual(found);
            EXPECT_NEAR(found.report.residual, measured, 0.01 * measured + 1e-15)
                << scene.cage.numVertices << " vertices at " << offset;
            EXPECT_TRUE(found.report.converged);
            EXPECT_LE(measured, 1.01 * std::max(kTolerance, found.report.rounding));
            EXPECT_LT(found.report.rounding, 1e-11 * (1.0 + offset));
        }
    }
}

// Constants that rounding puts into the residual are not multiplied until nothing else is left.
TEST(ReconstructAccuracy, SymmetricMeshesConvergeAtSixLevels) {
    for (int n : {3, 12, 24, 33}) {
        Reconstruction const found(test::MakeBipyramid(n), 6);
        EXPECT_TRUE(found.report.converged) << n;
        EXPECT_LE(found.report.iterations, 18) << n;
        EXPECT_LE(found.report.residual, std::max(kTolerance, found.report.rounding)) << n;
    }
}

}  // namespace
}  // namespace limn
