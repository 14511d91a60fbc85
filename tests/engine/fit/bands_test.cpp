// SPDX-License-Identifier: Apache-2.0
#include "engine/fit/bands.h"

#include <cmath>

#include <gtest/gtest.h>

#include "far_ext/limit/limit_matrix.h"
#include "far_ext/topology/refiner.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using Eigen::MatrixXd;
using test::Rows;
using test::ToRows;

eval::LimitOperator MakeOperator(engine::Scene const& scene) {
    return eval::LimitOperator::Build(*far_ext::CreateRefiner(scene.cage));
}

TEST(Bands, AddUpToTheMesh) {
    for (engine::Scene const& scene : test::MakeNoisyScenes()) {
        for (int count : {1, 2, 7, 40}) {
            auto const bands = engine::SplitIntoBands(scene, MakeOperator(scene), count);
            ASSERT_EQ(bands.size(), static_cast<size_t>(count) + 1);
            Rows sum = Rows::Zero(scene.cage.numVertices, 3);
            for (auto const& band : bands) sum += ToRows(band);
            EXPECT_LT(test::LargestOf(sum - ToRows(scene.positions)),
                      1e-13 * test::BoxDiagonal(scene.positions));
        }
    }
}

// b_i = (E-A)^i A M.
TEST(Bands, AreThoseOfTheSeries) {
    for (engine::Scene const& scene : test::MakeNoisyScenes()) {
        MatrixXd const A = far_ext::LimitMatrix::Build(*far_ext::CreateRefiner(scene.cage))
                               .AsMatrix(),
                       E = MatrixXd::Identity(A.rows(), A.cols());
        auto const bands = engine::SplitIntoBands(scene, MakeOperator(scene), 3);
        Rows power = ToRows(scene.positions);
        for (size_t i = 0; i < 3; ++i) {
            EXPECT_LT(test::LargestOf(ToRows(bands[i]) - A * power),
                      1e-13 * test::BoxDiagonal(scene.positions));
            power = (E - A) * power;
        }
        EXPECT_LT(test::LargestOf(ToRows(bands[3]) - power),
                  1e-13 * test::BoxDiagonal(scene.positions));
    }
}

// Q = M + (1,0,0): the constant difference is an eigenvector of D with eigenvalue 1; rho^k of it is
// left.
TEST(Morph, KeepsRhoToTheKOfAConstantDifference) {
    engine::Scene const to = test::MakeTorus(9, 7);
    engine::Scene from = to;
    for (size_t i = 0; i < from.positions.size(); i += 3) from.positions[i] += 1.0;
    int last = 0;
    engine::Morph(
        from, to, MakeOperator(to), 2, 0.8, 5, [&](int step, std::vector<double> const& Q) {
            EXPECT_EQ(step, ++last);
            for (size_t i = 0; i < Q.size(); ++i)
                ASSERT_NEAR(Q[i] - to.positions[i], i % 3 == 0 ? std::pow(0.8, step) : 0.0, 1e-13);
        });
    EXPECT_EQ(last, 5);
}

TEST(Morph, RefusesAnotherTopologyAndNamesTheFace) {
    engine::Scene const to = test::MakeTorus(9, 7);
    auto const refusal = [&](engine::Scene const& from) {
        return test::RefusalOf(
            [&] { engine::Morph(from, to, MakeOperator(to), 2, 0.8, 1, [](int, auto const&) {}); });
    };
    EXPECT_NE(refusal(test::MakeTorus(7, 9)).find("face 0 "), std::string::npos);
    EXPECT_NE(refusal(test::MakeCube()).find("8 and 63 vertices"), std::string::npos);
    engine::Scene turned = to;
    std::swap(turned.cage.faceVertices[21], turned.cage.faceVertices[22]);
    EXPECT_NE(refusal(turned).find("face 5 "), std::string::npos);
    engine::Scene broken = to;
    broken.positions[30] = NAN;
    EXPECT_NE(refusal(broken).find("vertex 10 "), std::string::npos);
}

TEST(MeshExtent, KnowsTheVolumeOfClosedMeshes) {
    auto const measure = [](engine::Scene const& scene) {
        return engine::MeasureExtent(scene, far_ext::CreateRefiner(scene.cage)->GetLevel(0));
    };
    EXPECT_NEAR(measure(test::MakeCube()).volume.value(), 8.0, 1e-14);
    EXPECT_FALSE(measure(test::MakeGridWithHole(5, 4)).volume.has_value());
    EXPECT_EQ(measure(test::MakeCube()).high[2], 1.0);
}

}  // namespace
}  // namespace limn
