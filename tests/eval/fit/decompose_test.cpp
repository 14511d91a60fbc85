// SPDX-License-Identifier: Apache-2.0
#include "eval/fit/decompose.h"

#include <cmath>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "engine/fit/bands.h"
#include "far_ext/limit/limit_matrix.h"
#include "far_ext/topology/refiner.h"
#include "support/files.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"

namespace limn {
namespace {

using Eigen::MatrixXd;
using Rows = Eigen::Matrix<double, -1, 3, Eigen::RowMajor>;

Rows ToRows(std::vector<double> const& values) {
    return Eigen::Map<Rows const>(values.data(), static_cast<Eigen::Index>(values.size()) / 3, 3);
}

eval::LimitOperator MakeOperator(engine::Scene const& scene,
                                 far_ext::LimitOptions const& options = {}) {
    return eval::LimitOperator::Build(*far_ext::CreateRefiner(scene.cage), 0, options);
}

MatrixXd MakeMatrix(engine::Scene const& scene) {
    return far_ext::LimitMatrix::Build(*far_ext::CreateRefiner(scene.cage)).AsMatrix();
}

std::vector<engine::Scene> MakeScenes() {
    std::vector<engine::Scene> scenes{test::MakeTorus(9, 7), test::MakeTriangleTorus(8, 6),
                                      test::MakeGridWithHole(5, 4), test::MakeCube()};
    scenes.push_back(test::LoadData("opensubdiv_shapes/catmark_cubes_semisharp.obj"));
    for (auto& scene : scenes) test::AddNoise(scene, 0.1, 2);
    return scenes;
}

double SizeOf(engine::Scene const& scene) {
    Rows const M = ToRows(scene.positions);
    return (M.colwise().maxCoeff() - M.colwise().minCoeff()).norm();
}

TEST(Decompose, BandsAddUpToTheMesh) {
    for (engine::Scene const& scene : MakeScenes()) {
        for (int count : {1, 2, 7, 40}) {
            auto const bands = engine::SplitIntoBands(scene, MakeOperator(scene), count);
            ASSERT_EQ(bands.size(), static_cast<size_t>(count) + 1);
            Rows sum = Rows::Zero(scene.cage.numVertices, 3);
            for (auto const& band : bands) sum += ToRows(band);
            EXPECT_LT((sum - ToRows(scene.positions)).cwiseAbs().maxCoeff(), 1e-13 * SizeOf(scene));
        }
    }
}

// b_i = (E-A)^i A M.
TEST(Decompose, BandsAreThoseOfTheSeries) {
    for (engine::Scene const& scene : MakeScenes()) {
        MatrixXd const A = MakeMatrix(scene), E = MatrixXd::Identity(A.rows(), A.cols());
        auto const bands = engine::SplitIntoBands(scene, MakeOperator(scene), 3);
        Rows power = ToRows(scene.positions);
        for (size_t i = 0; i < 3; ++i) {
            EXPECT_LT((ToRows(bands[i]) - A * power).cwiseAbs().maxCoeff(), 1e-13 * SizeOf(scene));
            power = (E - A) * power;
        }
        EXPECT_LT((ToRows(bands[3]) - power).cwiseAbs().maxCoeff(), 1e-13 * SizeOf(scene));
    }
}

// m = 0: A^k M; m = 1: (2A - A^2)^k M.
TEST(Decompose, DenoiseHasTheCorrectedPowers) {
    for (engine::Scene const& scene : MakeScenes()) {
        MatrixXd const A = MakeMatrix(scene), D = 2 * A - A * A;
        Rows const M = ToRows(scene.positions);
        std::vector<double> x = scene.positions;
        eval::Denoise(MakeOperator(scene), 3, 0, 2, x);
        EXPECT_LT((ToRows(x) - A * A * M).cwiseAbs().maxCoeff(), 1e-13 * SizeOf(scene));
        x = scene.positions;
        eval::Denoise(MakeOperator(scene), 3, 1, 2, x);
        EXPECT_LT((ToRows(x) - D * D * M).cwiseAbs().maxCoeff(), 1e-13 * SizeOf(scene));
    }
}

TEST(Decompose, FiltersMoveWithTheMesh) {
    for (engine::Scene const& scene : MakeScenes()) {
        auto const A = MakeOperator(scene);
        auto const run = [&](std::vector<double> x) {
            eval::Denoise(A, 3, 2, 1, x);
            eval::Sharpen(A, 3, 1, 3, 1, x);
            return x;
        };
        std::vector<double> moved = scene.positions;
        for (size_t i = 0; i < moved.size(); ++i) moved[i] += i % 3 == 0 ? 3.0 : -1.0;
        auto const still = run(scene.positions), after = run(moved);
        for (size_t i = 0; i < moved.size(); ++i)
            ASSERT_NEAR(after[i], still[i] + (i % 3 == 0 ? 3.0 : -1.0), 1e-12);
    }
}

// Q = M + (1,0,0): the constant difference is an eigenvector of D with eigenvalue 1; rho^k of it is
// left.
TEST(Decompose, MorphKeepsRhoToTheKOfAConstantDifference) {
    engine::Scene const to = test::MakeTorus(9, 7);
    engine::Scene from = to;
    for (size_t i = 0; i < from.positions.size(); i += 3) from.positions[i] += 1.0;
    engine::Morph(
        from, to, MakeOperator(to), 2, 0.8, 5, [&](int step, std::vector<double> const& Q) {
            for (size_t i = 0; i < Q.size(); ++i)
                ASSERT_NEAR(Q[i] - to.positions[i], i % 3 == 0 ? std::pow(0.8, step) : 0.0, 1e-13);
        });
    std::vector<double> Q = from.positions;
    eval::MorphStep(MakeOperator(to), 3, 2, 1.0, to.positions, Q);
    for (size_t i = 0; i < Q.size(); ++i) ASSERT_NEAR(Q[i], from.positions[i], 1e-13);
}

TEST(Decompose, MorphRefusesAnotherTopologyAndNamesTheFace) {
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

TEST(Decompose, GoldenResults) {
    struct Variant {
        std::string suffix;
        Sdc::SchemeType scheme;
        far_ext::LimitOptions options;
    };
    using Rule = far_ext::LimitOptions::AlphaRule;
    Variant const variants[] = {{"cc", Sdc::SCHEME_CATMARK, {}},
                                {"loop", Sdc::SCHEME_LOOP, {}},
                                {"cc_a50p", Sdc::SCHEME_CATMARK, {0.5, Rule::FirstStep}},
                                {"cc_a50s", Sdc::SCHEME_CATMARK, {0.5, Rule::Stationary}}};
    int numCompared = 0;
    for (std::string const name : {"cube", "icosa", "torustri", "gridholetri"}) {
        for (Variant const& variant : variants) {
            std::string const golden = "golden_surface/" + name + "_pi_" + variant.suffix;
            if (!std::filesystem::exists(test::DataPath(golden + "_denoise_m2k3.obj"))) continue;
            SCOPED_TRACE(golden);
            engine::Scene scene = test::LoadData("golden_surface/" + name + ".obj");
            scene.cage.scheme = variant.scheme;
            auto const A = MakeOperator(scene, variant.options);
            auto const expect = [&](std::vector<double> const& x, std::string const& suffix) {
                EXPECT_LT(
                    (ToRows(x) - test::LoadGoldenPoints(golden + suffix)).cwiseAbs().maxCoeff(),
                    1e-12);
                ++numCompared;
            };
            std::vector<double> x = scene.positions;
            eval::Denoise(A, 3, 2, 3, x);
            expect(x, "_denoise_m2k3.obj");
            x = scene.positions;
            eval::Sharpen(A, 3, 2, 4, 1, x);
            expect(x, "_sharpen_m2n4k1.obj");
            engine::Scene from = scene;
            for (size_t i = 0; i < x.size(); i += 3) {
                for (size_t c = 0; c < 3; ++c)
                    from.positions[i + c] += 0.1 * scene.positions[i + (c + 1) % 3];
            }
            engine::Morph(from, scene, A, 2, 0.8, 3, [&](int step, std::vector<double> const& Q) {
                if (step == 3) expect(Q, "_morph_m2r80k3.obj");
            });
        }
    }
    EXPECT_EQ(numCompared, 27);
}

TEST(Decompose, GivesTheSameBitsForAnyNumberOfThreads) {
    engine::Scene const scene = test::MakeTorus(120, 90);
    std::vector<double> first;
    for (size_t threads : {1, 3}) {
        tbb::global_control const limit(tbb::global_control::max_allowed_parallelism, threads);
        std::vector<double> x = scene.positions;
        eval::Denoise(MakeOperator(scene), 3, 2, 2, x);
        if (first.empty()) first = x;
        EXPECT_EQ(x, first);
    }
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
