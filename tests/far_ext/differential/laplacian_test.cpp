// SPDX-License-Identifier: Apache-2.0
#include "far_ext/differential/laplacian.h"

#include <numeric>

#include <gtest/gtest.h>

#include "far_ext/topology/boundary.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using far_ext::SparseRows;

std::vector<engine::Scene> AllMeshes() {
    std::vector<engine::Scene> scenes{test::MakeCube(), test::MakeTorus(7, 5),
                                      test::MakeTriangleTorus(6, 5),
                                      test::MakeFan(5, Sdc::SCHEME_CATMARK, 0.1, 0.05)};
    for (int n = 3; n <= 12; ++n) scenes.push_back(test::MakeBipyramid(n));
    for (char const* name : {"icosa", "gridholetri", "torustri"})
        scenes.push_back(test::LoadDifferential(name, Sdc::SCHEME_LOOP));
    return scenes;
}

double LargestRowSum(SparseRows const& rows) {
    double worst = 0.0;
    for (int row = 0; row < rows.GetNumRows(); ++row) {
        worst = test::Worse(
            worst, std::abs(std::accumulate(rows.weights.begin() + rows.offsets[row],
                                            rows.weights.begin() + rows.offsets[row + 1], 0.0)));
    }
    return worst;
}

// Moving everything changes no differential coordinate.
TEST(CombinatorialLaplacian, ConstantsGoToZero) {
    for (auto const& scene : AllMeshes()) {
        auto const refiner = test::MakeRefiner(scene, 2);
        for (int level = 0; level <= 2; ++level) {
            EXPECT_LT(LargestRowSum(far_ext::BuildCombinatorialLaplacian(refiner->GetLevel(level))),
                      1e-15);
        }
    }
}

// sum_i d_i (v_i - sum_j v_j / d_i) counts every edge twice, with opposite signs.
TEST(CombinatorialLaplacian, DegreesAreTheLeftNullVectorOfAClosedMesh) {
    int numClosed = 0;
    for (auto const& scene : AllMeshes()) {
        auto const refiner = test::MakeRefiner(scene, 1);
        auto const level = refiner->GetLevel(1);
        if (!far_ext::FindBoundaryLoops(level).empty()) continue;
        ++numClosed;
        SparseRows const rows = far_ext::BuildCombinatorialLaplacian(level);
        std::vector<double> sums(static_cast<size_t>(level.GetNumVertices()), 0.0);
        for (int row = 0; row < rows.GetNumRows(); ++row) {
            for (int k = rows.offsets[row]; k < rows.offsets[row + 1]; ++k) {
                sums[rows.indices[k]] += level.GetVertexEdges(row).size() * rows.weights[k];
            }
        }
        for (double sum : sums) EXPECT_NEAR(sum, 0.0, 1e-13);
    }
    EXPECT_EQ(numClosed, 15);
}

// A cube's corner (1,1,1) has neighbours whose mean is (1/3, 1/3, 1/3).
TEST(CombinatorialLaplacian, PointsOutwards) {
    auto const scene = test::MakeCube();
    auto const refiner = test::MakeRefiner(scene, 0);
    auto const delta =
        test::Apply(far_ext::BuildCombinatorialLaplacian(refiner->GetLevel(0)), scene.positions);
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(delta[3 * 6 + c], 2.0 / 3.0, 1e-15);
}

// On a sphere of radius 1, delta = 2 H n = 2 n.
TEST(CotangentLaplacian, IsTwiceTheMeanCurvatureNormalOfASphere) {
    auto const base = test::LoadDifferential("icosa", Sdc::SCHEME_LOOP);
    auto const refiner = test::MakeRefiner(base, 3);
    auto const level = refiner->GetLevel(3);
    auto const points = test::SubdivideToSphere(*refiner, base.positions);
    auto const laplacian = far_ext::BuildCotangentLaplacian(level, points);
    auto const delta = test::Apply(laplacian.rows, points);
    for (size_t i = 0; i < delta.size(); ++i)
        EXPECT_NEAR(delta[i] / laplacian.areas[i / 3], 2.0 * points[i], 0.02);
    EXPECT_LT(LargestRowSum(laplacian.rows), 1e-13);
    // Mixed areas tile the mesh: its area is that of the sphere less a little.
    EXPECT_NEAR(std::accumulate(laplacian.areas.begin(), laplacian.areas.end(), 0.0),
                4.0 * std::acos(-1.0), 0.1);
}

// On a sphere of radius 1 the mesh Laplace operator is 2 n, too, up to the unevenness of its
// triangles.
TEST(HeatLaplacian, IsTwiceTheMeanCurvatureNormalOfASphere) {
    auto const base = test::LoadDifferential("icosa", Sdc::SCHEME_LOOP);
    auto const refiner = test::MakeRefiner(base, 3);
    auto const points = test::SubdivideToSphere(*refiner, base.positions);
    auto const rows = far_ext::BuildHeatLaplacian(refiner->GetLevel(3), points).rows;
    EXPECT_LT(LargestRowSum(rows), 1e-9);  // of weights of some 100
    auto const delta = test::Apply(rows, points);
    for (size_t i = 0; i < delta.size(); ++i) EXPECT_NEAR(delta[i], 2.0 * points[i], 0.04);
}

// What the cut leaves out, summed over all vertices without one, is within its bound.
TEST(HeatLaplacian, TheCutKeepsItsBound) {
    auto const base = test::LoadDifferential("icosa", Sdc::SCHEME_LOOP);
    auto const refiner = test::MakeRefiner(base, 3);
    auto const points = test::SubdivideToSphere(*refiner, base.positions);
    far_ext::HeatKernel kernel;
    auto const laplacian = far_ext::BuildHeatLaplacian(refiner->GetLevel(3), points, &kernel);
    auto const areas = far_ext::BuildCotangentLaplacian(refiner->GetLevel(3), points).areas;
    double const total = std::accumulate(areas.begin(), areas.end(), 0.0);
    double weightAtRadius = std::exp(-kernel.radius * kernel.radius / (4 * kernel.time)) /
                            (4 * std::acos(-1.0) * kernel.time * kernel.time);
    EXPECT_NEAR(kernel.truncation, weightAtRadius * total, 1e-6 * kernel.truncation);
    EXPECT_LT(laplacian.rows.weights.size(),
              400u * static_cast<size_t>(laplacian.rows.GetNumRows()));
}

TEST(AreaLaplacians, ATriangleWithoutAreaIsNamed) {
    auto scene = test::MakeBipyramid(5);
    scene.positions[6] = scene.positions[9],
    scene.positions[7] = scene.positions[10];  // vertex 2 onto 3
    auto const refiner = test::MakeRefiner(scene, 0);
    auto const refusal = test::RefusalOf(
        [&] { far_ext::BuildCotangentLaplacian(refiner->GetLevel(0), scene.positions); });
    EXPECT_NE(refusal.find("face 0 (vertices 0, 2, 3) has no area"), std::string::npos) << refusal;
    auto const cube = test::MakeCube();
    auto const quads = test::MakeRefiner(cube, 0);
    EXPECT_EQ(
        test::CodeOf([&] { far_ext::BuildHeatLaplacian(quads->GetLevel(0), cube.positions); }),
        ErrorCode::Unsupported);
}

}  // namespace
}  // namespace limn
