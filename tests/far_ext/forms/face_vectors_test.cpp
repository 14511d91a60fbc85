// SPDX-License-Identifier: Apache-2.0
#include "far_ext/forms/face_vectors.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "support/fit_meshes.h"
#include "support/form_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

// The gradient of a coordinate on a flat face is the axis less its normal part.
TEST(FaceVectors, AreExactForConstantFields) {
    int numCompared = 0;
    for (engine::Scene const& scene :
         {test::MakeCube(), test::MakeDodecahedron(), test::MakeIrregularTriangles(9, 8, 2),
          test::MakeFan(5, Sdc::SCHEME_LOOP, 0.1, 0.05), test::LoadSpot(),
          test::LoadAsset("tri/eight.off")}) {
        auto const refiner = test::MakeRefiner(scene, 0);
        auto const level = refiner->GetLevel(0);
        auto const rows = far_ext::BuildFaceVectors(level, scene.positions);
        for (size_t axis = 0; axis < 3; ++axis) {
            auto const form = test::MakeCoordinateForm(level, scene.positions, axis);
            std::vector<double> vectors(3 * static_cast<size_t>(level.GetNumFaces()));
            rows.Apply(form.data(), vectors.data(), 1);
            for (Index face = 0; face < level.GetNumFaces(); ++face) {
                auto const corners = level.GetFaceVertices(face);
                auto const at = [&](int j) {
                    return Eigen::Map<Eigen::Vector3d const>(
                        &scene.positions[3 * static_cast<size_t>(corners[j])]);
                };
                Eigen::Vector3d const normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
                bool isFlat = true;
                for (int j = 3; j < corners.size(); ++j)
                    isFlat = isFlat && std::abs(normal.dot(at(j) - at(0))) < 1e-12;
                if (!isFlat) continue;
                Eigen::Vector3d const expected =
                    Eigen::Vector3d::Unit(static_cast<Eigen::Index>(axis)) -
                    normal[static_cast<Eigen::Index>(axis)] * normal;
                EXPECT_LT(
                    (Eigen::Map<Eigen::Vector3d const>(&vectors[3 * static_cast<size_t>(face)]) -
                     expected)
                        .norm(),
                    1e-9)
                    << scene.path << ", face " << face;
                ++numCompared;
            }
        }
    }
    EXPECT_GE(numCompared, 3 * (6 + 12 + 144 + 634));  // all but the fan's and spot's
}

// Its two halves have opposite areas.
TEST(FaceVectors, OfAQuadThatCrossesItselfAreZero) {
    auto const scene = test::MakeScene({0, 0, 1, 1, 0, 1, 1, 0, 2, 0, 0, 0}, {{0, 1, 2, 3}});
    auto const refiner = test::MakeRefiner(scene, 0);
    auto const rows = far_ext::BuildFaceVectors(refiner->GetLevel(0), scene.positions);
    for (double const weight : rows.weights) EXPECT_EQ(weight, 0.0);
}

}  // namespace
}  // namespace limn
