// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/mesh_curvature.h"

#include <gtest/gtest.h>

#include "support/refined.h"

namespace limn {
namespace {

// Curvature 1 everywhere: an energy of 2 per area, 8 pi in all. The same figures as an independent
// implementation's.
TEST(MeshCurvature, TheUnitSphereHasItsEnergy) {
    auto const scene = test::LoadDifferential("icosa", Sdc::SCHEME_LOOP);
    auto const refiner = test::MakeRefiner(scene, 4);
    auto const level = refiner->GetLevel(4);
    auto const points = test::SubdivideToSphere(*refiner, scene.positions);
    auto const curvature = eval::MeasureMeshCurvature(level, points);
    auto const energy = eval::FindThinPlateEnergy(curvature);
    EXPECT_NEAR(energy.mean, 2.0, 0.01);
    EXPECT_NEAR(energy.integral, 8.0 * std::acos(-1.0), 0.15);
    for (size_t i = 0; i < curvature.areas.size(); ++i)
        EXPECT_NEAR(curvature.GetMean(i), 1.0, 0.15);
    EXPECT_NEAR(eval::MeasureMeshCurvature(level, points, Orientation::Left).GetMean(0),
                -curvature.GetMean(0), 1e-12);
}

// The energy per area goes with 1/length^2, its integral has no scale.
TEST(MeshCurvature, ScalesAsItShould) {
    auto scene = test::MakeTorus(40, 24);
    auto const refiner = test::MakeRefiner(scene, 0);
    auto const before = eval::FindThinPlateEnergy(
        eval::MeasureMeshCurvature(refiner->GetLevel(0), scene.positions));
    for (double& x : scene.positions) x *= 10.0;
    auto const after = eval::FindThinPlateEnergy(
        eval::MeasureMeshCurvature(refiner->GetLevel(0), scene.positions));
    EXPECT_NEAR(after.integral, before.integral, 1e-9 * before.integral);
    EXPECT_NEAR(after.mean, 0.01 * before.mean, 1e-9 * before.mean);
}

TEST(MeshCurvature, BoundariesAndPlanesHaveNone) {
    auto const scene = test::MakeFan(6, Sdc::SCHEME_LOOP, 0.0, 0.0);
    auto const refiner = test::MakeRefiner(scene, 0);
    auto const curvature = eval::MeasureMeshCurvature(refiner->GetLevel(0), scene.positions);
    for (Index v = 0; v < scene.cage.numVertices; ++v) {
        bool const isInside = refiner->GetLevel(0).GetVertexFaces(v).size() > 0 &&
                              !refiner->GetLevel(0).IsVertexBoundary(v);
        EXPECT_EQ(curvature.areas[v] > 0.0, isInside);
        EXPECT_NEAR(curvature.k1[v], 0.0, 1e-12);
    }
}

}  // namespace
}  // namespace limn
