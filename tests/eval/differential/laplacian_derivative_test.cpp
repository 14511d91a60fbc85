// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/laplacian_derivative.h"

#include <gtest/gtest.h>

#include "far_ext/rows/breadth_first.h"
#include "far_ext/rows/points.h"
#include "support/area_laplacians.h"
#include "support/fit_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using eval::AreaLaplacianKind;
using eval::DoubleLanes;
using eval::LaneRows;

/// A level with its graph, and what L(V) V and the areas are there.
struct Linearised {
    std::unique_ptr<Far::TopologyRefiner> refiner;
    std::vector<double> positions;
    std::vector<eval::MultigridLevel> levels;
    std::unique_ptr<eval::LaplacianDerivative> derivative;

    Linearised(engine::Scene const& scene, int numLevels, AreaLaplacianKind kind)
        : refiner(test::MakeRefiner(scene, numLevels)), positions(scene.positions) {
        for (int k = 1; k <= numLevels; ++k)
            positions = eval::RefineValues<3>(*refiner, k, positions);
        levels = eval::BuildMultigridLevels(*refiner, eval::FixedVertices::Boundary, numLevels);
        auto const rowsOf = far_ext::InvertOrder(GetGraph().vertices);
        far_ext::HeatKernel kernel;
        auto const laplacian = test::BuildLaplacian(kind, GetLevel(), positions, &kernel);
        derivative = kind == AreaLaplacianKind::Heat
                         ? eval::DifferentiateHeat(GetLevel(), GetGraph(), rowsOf, positions,
                                                   laplacian, kernel)
                         : eval::DifferentiateCotangents(GetLevel(), GetGraph(), rowsOf, positions);
    }

    Far::TopologyLevel GetLevel() const { return refiner->GetLevel(refiner->GetMaxLevel()); }
    eval::MultigridLevel const& GetGraph() const { return levels.back(); }

    /// Lanes of unknowns, 0 at fixed vertices.
    LaneRows MakeLanes(unsigned seed, int numLanes) const {
        auto const noise = test::MakeNoise(4 * GetGraph().vertices.size(), seed);
        LaneRows lanes(GetGraph().vertices.size(), DoubleLanes::Zero());
        for (size_t row = 0; row < static_cast<size_t>(GetGraph().numUnknowns); ++row) {
            for (int lane = 0; lane < numLanes; ++lane)
                lanes[row][lane] = noise[4 * row + static_cast<size_t>(lane)];
        }
        return lanes;
    }

    /// g and the areas of moved positions.
    LaneRows Measure(AreaLaplacianKind kind, LaneRows const& move, double share) const {
        auto moved = positions;
        for (size_t row = 0; row < move.size(); ++row) {
            for (Index c = 0; c < 3; ++c)
                moved[3 * static_cast<size_t>(GetGraph().vertices[row]) + static_cast<size_t>(c)] +=
                    share * move[row][c];
        }
        auto const laplacian = test::BuildLaplacian(kind, GetLevel(), moved);
        auto const images = far_ext::FindDeltas(laplacian.rows, moved);
        auto const areas = kind == AreaLaplacianKind::Heat
                               ? far_ext::FindVertexAreas(GetLevel(), moved)
                               : laplacian.areas;
        LaneRows found;
        for (Index vertex : GetGraph().vertices) {
            auto const image = far_ext::Points(images)[vertex];
            found.emplace_back(image[0], image[1], image[2], areas[vertex]);
        }
        return found;
    }
};

double Product(LaneRows const& a, LaneRows const& b) {
    double sum = 0.0;
    for (size_t row = 0; row < a.size(); ++row) sum += (a[row] * b[row]).sum();
    return sum;
}

/// All bumpy: a right angle is where mixed areas have no derivative.
std::vector<engine::Scene> OpenAndClosedTriangles() {
    std::vector<engine::Scene> scenes{
        test::MakeTriangleTorus(7, 5), test::MakeFan(6, Sdc::SCHEME_LOOP, 0.1, 0.05),
        test::LoadDifferential("gridholetri", Sdc::SCHEME_LOOP), test::MakeBipyramid(5)};
    for (auto& scene : scenes) test::AddNoise(scene, 0.1, 7);
    return scenes;
}

class DerivativeOf : public testing::TestWithParam<AreaLaplacianKind> {};
INSTANTIATE_TEST_SUITE_P(Laplacians, DerivativeOf,
                         testing::Values(AreaLaplacianKind::Cotangent, AreaLaplacianKind::Heat));

// The other road are differences.
TEST_P(DerivativeOf, DifferencesAreMet) {
    for (auto const& scene : OpenAndClosedTriangles()) {
        Linearised const at(scene, 1, GetParam());
        LaneRows const move = at.MakeLanes(1, 3);
        LaneRows change(move.size(), DoubleLanes::Zero());
        at.derivative->Apply(move, change);
        double const share = 1e-7 * test::BoxDiagonal(at.positions);
        LaneRows const there = at.Measure(GetParam(), move, share),
                       back = at.Measure(GetParam(), move, -share);
        double misfit = 0.0, size = 0.0;
        for (Index row = 0; row < at.GetGraph().numUnknowns; ++row) {
            DoubleLanes const expected = (there[row] - back[row]) / (2.0 * share);
            misfit += (change[row] - expected).square().sum();
            size += expected.square().sum();
        }
        EXPECT_LT(std::sqrt(misfit / size), 2e-6) << scene.cage.numVertices;
    }
}

TEST_P(DerivativeOf, TheTransposeIsTheTranspose) {
    for (auto const& scene : OpenAndClosedTriangles()) {
        Linearised const at(scene, 2, GetParam());
        LaneRows const move = at.MakeLanes(1, 3), factors = at.MakeLanes(2, 4);
        LaneRows change(move.size(), DoubleLanes::Zero()), gradient = change;
        at.derivative->Apply(move, change);
        at.derivative->ApplyTransposed(factors, gradient);
        double const there = Product(change, factors), back = Product(move, gradient);
        EXPECT_NEAR(there, back,
                    1e-6 * std::sqrt(Product(change, change) * Product(factors, factors)))
            << scene.cage.numVertices;
    }
}

}  // namespace
}  // namespace limn
