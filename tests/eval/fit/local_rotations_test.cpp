// SPDX-License-Identifier: Apache-2.0
#include "eval/fit/local_rotations.h"

#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "far_ext/topology/refiner.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using eval::LocalRotations;
using test::Rows;
using test::ToRows;

std::vector<double> Turn(std::vector<double> const& points, Eigen::Matrix3d const& R) {
    Rows const turned = ToRows(points) * R.transpose();
    return {turned.data(), turned.data() + turned.size()};
}

Eigen::Matrix3d MakeRotation(double angle) {
    return Eigen::AngleAxisd(angle, Eigen::Vector3d(0.3, 1.0, -0.7).normalized())
        .toRotationMatrix();
}

TEST(LocalRotations, OfATurnedMeshAreThatTurn) {
    for (engine::Scene const& scene : test::MakeNoisyScenes()) {
        auto const refiner = far_ext::CreateRefiner(scene.cage);
        auto const R = MakeRotation(2.0);
        LocalRotations const rotations(refiner->GetLevel(0), scene.positions,
                                       Turn(scene.positions, R));
        std::vector<double> const vectors = test::MakeNoise(scene.positions.size(), 4);
        std::vector<double> turned = vectors;
        rotations.Apply(turned);
        EXPECT_LT(test::LargestDifference(turned, Turn(vectors, R)), 1e-12);
        EXPECT_NEAR(rotations.FindLargestTurn(), 2.0 * 180.0 / std::numbers::pi, 1e-9);
    }
}

// Sizes do not matter, not even those whose squares are 0 or infinite.
TEST(LocalRotations, OfMeshesOfAnySizeAreTheSame) {
    engine::Scene const scene = test::MakeNoisyScenes().front();
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const R = MakeRotation(1.0);
    for (double size : {1e-200, 1e200}) {
        std::vector<double> to = Turn(scene.positions, R);
        for (double& x : to) x *= size;
        LocalRotations const rotations(refiner->GetLevel(0), scene.positions, to);
        std::vector<double> turned = scene.positions;
        rotations.Apply(turned);
        EXPECT_LT(test::LargestDifference(turned, Turn(scene.positions, R)), 1e-12);
    }
}

// A flat piece bent round a cylinder of radius 1: a vertex at x is turned by x about y.
TEST(LocalRotations, FollowTheBendOfASheet) {
    int const n = 9;
    std::vector<double> flat, bent;
    std::vector<std::vector<Index>> faces;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            double const x = 0.1 * i, y = 0.1 * j;
            flat.insert(flat.end(), {x, y, 0.0});
            bent.insert(bent.end(), {std::sin(x), y, std::cos(x)});
            if (i + 1 == n || j + 1 == n) continue;
            Index const corner = n * i + j;
            faces.push_back({corner, corner + n, corner + n + 1, corner + 1});
        }
    }
    engine::Scene const scene = test::MakeScene(flat, faces, Sdc::SCHEME_CATMARK);
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    LocalRotations const rotations(refiner->GetLevel(0), flat, bent);
    std::vector<double> normals(flat.size(), 0.0);
    for (size_t i = 2; i < normals.size(); i += 3) normals[i] = 1.0;
    rotations.Apply(normals);
    for (size_t vertex = n; vertex + n < flat.size() / 3; ++vertex) {  // not at the cut ends
        double const x = flat[3 * vertex];
        EXPECT_NEAR(normals[3 * vertex], std::sin(x), 1e-12);
        EXPECT_NEAR(normals[3 * vertex + 2], std::cos(x), 1e-12);
    }
}

// Two vertices lie in one place, and a third belongs to no face: nothing says how they turn.
TEST(LocalRotations, StayWhereThereIsNothingToTurn) {
    engine::Scene const scene =
        test::MakeScene({1, 2, 3, 1, 2, 3, 1, 2, 3, 7, 7, 7}, {{0, 1, 2}}, Sdc::SCHEME_CATMARK);
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    LocalRotations const rotations(refiner->GetLevel(0), scene.positions, scene.positions);
    std::vector<double> vectors = scene.positions;
    rotations.Apply(vectors);
    EXPECT_EQ(vectors, scene.positions);
    EXPECT_EQ(rotations.FindLargestTurn(), 0.0);
}

}  // namespace
}  // namespace limn
