// SPDX-License-Identifier: Apache-2.0
#include "engine/fit/bands.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "far_ext/limit/limit_matrix.h"
#include "far_ext/topology/refiner.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/listener.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using Eigen::MatrixXd;
using test::Rows;
using test::ToRows;

engine::Bands Split(engine::Scene const& scene, int count) {
    engine::Job job;
    return engine::SplitIntoBands(engine::Model::Build(scene), count, {}, job);
}

TEST(MeasureExtent, WantsAPositionPerVertex) {
    auto const model = engine::Model::Build(test::MakeCube());
    EXPECT_EQ(test::RefusalOf([&] { engine::MeasureExtent(model, std::vector<double>(3)); }),
              "positions: 3 values are too few for 8 vertices of 3");
}

TEST(Bands, RefuseNumbersOutOfRange) {
    engine::Job job;
    auto const model = engine::Model::Build(test::MakeTorus(9, 7));
    for (auto const& [run, message] : std::vector<std::pair<std::function<void()>, char const*>>{
             {[&] { engine::SplitIntoBands(model, -5, {}, job); }, "`count`: -5"},
             {[&] { engine::SplitIntoBands(model, 1001, {}, job); }, "from 0 to 1000"},
             {[&] { engine::Denoise(model, {.detail = -1}, job); }, "`detail`: -1"},
             {[&] { engine::Denoise(model, {.steps = -1}, job); }, "`steps`: -1"},
             {[&] { engine::Sharpen(model, {.steps = -1}, job); }, "`steps`: -1"},
             {[&] { engine::Sharpen(model, {.last = 1001}, job); }, "`last`: 1001"}}) {
        auto const error = test::CatchError(std::cref(run));
        ASSERT_TRUE(error) << message;
        EXPECT_EQ(error->GetCode(), ErrorCode::BadOption) << message;
        EXPECT_NE(std::string(error->what()).find(message), std::string::npos) << error->what();
    }
}

TEST(Bands, AddUpToTheMesh) {
    for (engine::Scene const& scene : test::MakeNoisyScenes()) {
        for (int count : {1, 2, 7, 40}) {
            auto const [bands, remainder] = Split(scene, count);
            ASSERT_EQ(bands.size(), static_cast<size_t>(count));
            Rows sum = ToRows(remainder);
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
        auto const [bands, remainder] = Split(scene, 3);
        Rows power = ToRows(scene.positions);
        for (auto const& band : bands) {
            EXPECT_LT(test::LargestOf(ToRows(band) - A * power),
                      1e-13 * test::BoxDiagonal(scene.positions));
            power = (E - A) * power;
        }
        EXPECT_LT(test::LargestOf(ToRows(remainder) - power),
                  1e-13 * test::BoxDiagonal(scene.positions));
    }
}

// What is kept are the first bands; what is added again are powers of the high-pass filter.
TEST(Bands, DenoisingAndSharpeningAreSumsOfThem) {
    engine::Job job;
    for (engine::Scene const& scene : test::MakeNoisyScenes()) {
        auto const model = engine::Model::Build(scene);
        auto const [bands, remainder] = Split(scene, 4);
        Rows const mesh = ToRows(scene.positions);
        double const size = test::BoxDiagonal(scene.positions);
        Rows low = ToRows(bands[0]);
        for (int i = 1; i <= 2; ++i) low += ToRows(bands[i]);
        EXPECT_LT(test::LargestOf(ToRows(engine::Denoise(model, {.detail = 2}, job)) - low),
                  1e-13 * size);
        // (E-A)^3 M is the fourth band and what remains.
        Rows const sharp = mesh + ToRows(bands[3]) + ToRows(remainder);
        EXPECT_LT(
            test::LargestOf(ToRows(engine::Sharpen(model, {.first = 3, .last = 3}, job)) - sharp),
            1e-13 * size);
    }
}

TEST(Bands, AreSharpenedInOrder) {
    engine::Job job;
    auto const model = engine::Model::Build(test::MakeCube());
    for (auto const& [first, last] : {std::pair{3, 2}, {0, 2}, {-1, -1}}) {
        EXPECT_EQ(
            test::CodeOf([&] { engine::Sharpen(model, {.first = first, .last = last}, job); }),
            ErrorCode::BadOption);
    }
}

std::vector<std::string> WarningsOfSharpening(int steps) {
    test::Listener listener;
    engine::Job job(listener.MakeHost());
    engine::Sharpen(engine::Model::Build(test::MakeNoisyScenes()[0]), {.steps = steps}, job);
    return listener.warnings;
}

// Each step multiplies by up to 4, so that 1 stays below 10, and 2000 leave double.
TEST(Bands, SharpeningThatOutgrowsTheMeshIsWarnedOfOnce) {
    EXPECT_TRUE(WarningsOfSharpening(1).empty());
    auto const warnings = WarningsOfSharpening(30);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("of 30 steps the mesh reaches more than 10 times"),
              std::string::npos)
        << warnings[0];
    EXPECT_NE(warnings[0].find("fewer `steps`"), std::string::npos) << warnings[0];
    EXPECT_EQ(test::CodeOf([] { WarningsOfSharpening(2000); }), ErrorCode::TooLarge);
}

TEST(Bands, FiltersStopWhereTheirHostWants) {
    auto const model = engine::Model::Build(test::MakeTorus(9, 7));
    using engine::Job;
    EXPECT_TRUE(test::StopsHalfway([&](Job& job) { engine::SplitIntoBands(model, 9, {}, job); }));
    EXPECT_TRUE(test::StopsHalfway([&](Job& job) { engine::Denoise(model, {.steps = 4}, job); }));
    EXPECT_TRUE(test::StopsHalfway([&](Job& job) { engine::Sharpen(model, {.steps = 4}, job); }));
}

TEST(MeshExtent, KnowsTheVolumeOfClosedMeshes) {
    auto const measure = [](engine::Scene const& scene) {
        return engine::MeasureExtent(engine::Model::Build(scene), scene.positions);
    };
    EXPECT_NEAR(measure(test::MakeCube()).volume.value(), 8.0, 1e-14);
    EXPECT_FALSE(measure(test::MakeGridWithHole(5, 4)).volume.has_value());
    EXPECT_EQ(measure(test::MakeCube()).high[2], 1.0);
}

}  // namespace
}  // namespace limn
