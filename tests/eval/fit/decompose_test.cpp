// SPDX-License-Identifier: Apache-2.0
#include "eval/fit/decompose.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "far_ext/limit/limit_matrix.h"
#include "far_ext/topology/refiner.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using Eigen::MatrixXd;
using test::Rows;
using test::ToRows;

eval::LimitOperator MakeOperator(engine::Scene const& scene,
                                 far_ext::LimitOptions const& options = {}) {
    return eval::LimitOperator::Build(*far_ext::CreateRefiner(scene.cage), 0, options);
}

MatrixXd MakeMatrix(engine::Scene const& scene) {
    return far_ext::LimitMatrix::Build(*far_ext::CreateRefiner(scene.cage)).AsMatrix();
}

// m = 0: A^k M; m = 1: (2A - A^2)^k M.
TEST(Decompose, DenoiseHasTheCorrectedPowers) {
    for (engine::Scene const& scene : test::MakeNoisyScenes()) {
        MatrixXd const A = MakeMatrix(scene), D = 2 * A - A * A;
        Rows const M = ToRows(scene.positions);
        std::vector<double> x = scene.positions;
        eval::Denoise(MakeOperator(scene), 3, 0, 2, x);
        EXPECT_LT(test::LargestOf(ToRows(x) - A * A * M),
                  1e-13 * test::BoxDiagonal(scene.positions));
        x = scene.positions;
        eval::Denoise(MakeOperator(scene), 3, 1, 2, x);
        EXPECT_LT(test::LargestOf(ToRows(x) - D * D * M),
                  1e-13 * test::BoxDiagonal(scene.positions));
    }
}

TEST(Decompose, FiltersMoveWithTheMesh) {
    for (engine::Scene const& scene : test::MakeNoisyScenes()) {
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

// The constant difference is an eigenvector of D with eigenvalue 1; a step leaves rho of it.
TEST(Decompose, AMorphStepKeepsRhoOfAConstantDifference) {
    engine::Scene const to = test::MakeTorus(9, 7);
    for (double rho : {0.8, 1.0}) {
        std::vector<double> x = to.positions;
        for (size_t i = 0; i < x.size(); i += 3) x[i] += 1.0;
        eval::MorphStep(MakeOperator(to), 3, 2, rho, to.positions, x);
        for (size_t i = 0; i < x.size(); ++i)
            ASSERT_NEAR(x[i] - to.positions[i], i % 3 == 0 ? rho : 0.0, 1e-13);
    }
}

TEST(Decompose, MeetsTheGoldenResults) {
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
                EXPECT_LT(test::LargestDifference(x, test::LoadPoints(golden + suffix)), 1e-12);
                ++numCompared;
            };
            std::vector<double> x = scene.positions;
            eval::Denoise(A, 3, 2, 3, x);
            expect(x, "_denoise_m2k3.obj");
            x = scene.positions;
            eval::Sharpen(A, 3, 2, 4, 1, x);
            expect(x, "_sharpen_m2n4k1.obj");
            x = scene.positions;
            for (size_t i = 0; i < x.size(); ++i)
                x[i] += 0.1 * scene.positions[i - i % 3 + (i + 1) % 3];
            for (int step = 0; step < 3; ++step) eval::MorphStep(A, 3, 2, 0.8, scene.positions, x);
            expect(x, "_morph_m2r80k3.obj");
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

}  // namespace
}  // namespace limn
