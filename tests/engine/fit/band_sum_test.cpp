// SPDX-License-Identifier: Apache-2.0
#include "engine/fit/band_sum.h"

#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "engine/fit/bands.h"
#include "far_ext/limit/limit_matrix.h"
#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/listener.h"
#include "support/meshes.h"
#include "support/values.h"

namespace limn {
namespace {

using engine::BandSumOptions;
using engine::Carry;
using engine::Model;
using eval::BandGains;
using test::Rows;
using test::ToRows;

Rows Sum(Model const& model, BandSumOptions const& options) {
    engine::Job job;
    return ToRows(engine::SumBands(model, options, job).positions);
}

/// A noisy torus, and the same with other noise and a bend.
std::pair<Model, Model> MakePair() {
    engine::Scene mesh = test::MakeTorus(14, 10), other = mesh;
    test::AddNoise(mesh, 0.2, 3);
    test::AddNoise(other, 0.4, 8);
    for (size_t i = 0; i < other.positions.size(); i += 3)
        other.positions[i + 2] += 0.3 * other.positions[i] * other.positions[i];
    return {Model::Build(mesh), Model::Build(other)};
}

Eigen::Matrix3d MakeTurn(double degrees) {
    double const angle = degrees * std::numbers::pi / 180.0;
    return Eigen::AngleAxisd(angle, Eigen::Vector3d(1.0, -2.0, 0.5).normalized())
        .toRotationMatrix();
}

Model Move(Model const& model, Eigen::Matrix3d const& turn, Eigen::RowVector3d const& shift) {
    Rows const moved = (ToRows(model.GetPositions()) * turn.transpose()).rowwise() + shift;
    return model.WithPoints({moved.data(), moved.data() + moved.size()});
}

TEST(BandSum, GainsOfOneGiveTheMesh) {
    for (engine::Scene const& scene : test::MakeNoisyScenes()) {
        Rows const sum = Sum(Model::Build(scene), {.gains = {0, {1.0, 1.0, 1.0}, 1.0}});
        EXPECT_LT(test::LargestOf(sum - ToRows(scene.positions)),
                  1e-13 * test::BoxDiagonal(scene.positions));
    }
}

TEST(BandSum, IsLinearInItsGains) {
    auto const [model, other] = MakePair();
    auto const sum = [&, &mesh = model](double a, double b, double r) {
        return Sum(mesh, {.gains = {0, {a, b}, r}});
    };
    Rows const apart = 2.0 * sum(1.0, 0.5, -1.0) - 3.0 * sum(-0.25, 2.0, 0.5);
    EXPECT_LT(test::LargestOf(sum(2.75, -5.0, -3.5) - apart), 1e-12);
}

// D = E - (E-A)^(m+1) keeps the first m + 1 bands.
TEST(BandSum, WithoutTheRemainderIsADenoisedMesh) {
    engine::Job job;
    for (engine::Scene const& scene : test::MakeNoisyScenes()) {
        auto const model = Model::Build(scene);
        for (int detail : {0, 2, 5}) {
            std::vector<double> const ones(static_cast<size_t>(detail) + 1, 1.0);
            Rows const low = Sum(model, {.gains = {0, ones, 0.0}});
            Rows const denoised = ToRows(engine::Denoise(model, {.detail = detail}, job));
            EXPECT_LT(test::LargestOf(low - denoised), 1e-13 * test::BoxDiagonal(scene.positions));
        }
    }
}

TEST(BandSum, BandsOfTheMeshItselfGiveTheMesh) {
    for (engine::Scene const& scene : test::MakeNoisyScenes()) {
        auto const model = Model::Build(scene);
        for (Carry carry : {Carry::Object, Carry::Local}) {
            for (BandGains const& gains :
                 {BandGains{1, {}, 1.0}, BandGains{0, {1.0, 1.0}, {}}, BandGains{3, {1.0}, {}}}) {
                Rows const same = Sum(model, {.gains = gains, .from = model, .carry = carry});
                EXPECT_LT(test::LargestOf(same - ToRows(scene.positions)),
                          1e-13 * test::BoxDiagonal(scene.positions));
            }
        }
    }
}

// M - b(M) + g b(O), b(X) = (E-A)^1 X - (E-A)^3 X, in whole matrices.
TEST(BandSum, TakesTheOthersBandsInPlaceOfItsOwn) {
    auto const [model, other] = MakePair();
    Eigen::MatrixXd const A = far_ext::LimitMatrix::Build(model.GetRefiner()).AsMatrix(),
                          H = Eigen::MatrixXd::Identity(A.rows(), A.cols()) - A;
    Rows const M = ToRows(model.GetPositions()), O = ToRows(other.GetPositions());
    Rows const expected = M - (H * M - H * H * H * M) + 2.0 * (H * A * O) + 0.5 * (H * H * A * O);
    Rows const sum =
        Sum(model, {.gains = {1, {2.0, 0.5}, {}}, .from = other, .carry = Carry::Object});
    EXPECT_LT(test::LargestOf(sum - expected), 1e-13);
}

TEST(BandSum, InLocalFramesDoesNotSeeHowTheOtherMeshStands) {
    auto const [model, other] = MakePair();
    Model const moved = Move(other, MakeTurn(70.0), {3.0, -1.0, 2.0});
    auto const change = [&, &mesh = model, &still = other](Carry carry) {
        BandSumOptions options{.gains = {1, {}, 1.0}, .from = still, .carry = carry};
        Rows const before = Sum(mesh, options);
        options.from = moved;
        return test::LargestOf(Sum(mesh, options) - before);
    };
    EXPECT_LT(change(Carry::Local), 1e-12);
    EXPECT_GT(change(Carry::Object), 0.05);
}

TEST(BandSum, TellsByHowMuchItHasTurnedBands) {
    auto const [model, other] = MakePair();
    engine::Job job;
    for (double degrees : {0.0, 25.0, 170.0}) {
        BandSumOptions const options{.gains = {1, {}, 1.0},
                                     .from = Move(model, MakeTurn(degrees), {0.0, 5.0, 0.0})};
        auto const sum = engine::SumBands(model, options, job);
        EXPECT_NEAR(sum.largestTurnDegrees, degrees, 1e-5);
        EXPECT_LT(test::LargestOf(ToRows(sum.positions) - ToRows(model.GetPositions())), 1e-12);
    }
}

// The parts, weighed, are what the mesh's bands are.
TEST(BandSum, TellsOfEachBandHowLargeItIs) {
    auto const [model, other] = MakePair();
    engine::Job job;
    auto const bands = engine::SplitIntoBands(model, 3, {}, job);
    auto const parts = engine::SumBands(model, {.gains = {1, {2.0, 3.0}, 4.0}}, job).parts;
    ASSERT_EQ(parts.size(), 3u);
    auto const rms = [](std::vector<double> const& band) {
        return std::sqrt(ToRows(band).rowwise().squaredNorm().mean());
    };
    for (int i : {0, 1}) {
        EXPECT_EQ(parts[i].band, i + 1);
        EXPECT_EQ(parts[i].gain, 2.0 + i);
        EXPECT_NEAR(parts[i].rms, rms(bands.bands[i + 1]), 1e-14);
    }
    EXPECT_FALSE(parts[2].band.has_value());
    EXPECT_NEAR(parts[2].rms, rms(bands.remainder), 1e-14);
}

TEST(BandSum, WantsTheSameFacesAndNamesTheFirstThatDiffers) {
    engine::Scene const torus = test::MakeTorus(9, 7);
    engine::Scene turned = torus;
    std::swap(turned.cage.faceVertices[21], turned.cage.faceVertices[22]);
    auto const model = Model::Build(torus);
    engine::Job job;
    auto const error = test::CatchError([&] {
        engine::SumBands(model, {.gains = {1, {}, 1.0}, .from = Model::Build(turned)}, job);
    });
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->GetCode(), ErrorCode::BadMesh);
    EXPECT_NE(std::string(error->what()).find("face 5 "), std::string::npos);
    EXPECT_EQ(test::CodeOf([&] { engine::SumBands(model, {.gains = {-1, {1.0}, {}}}, job); }),
              ErrorCode::BadOption);
}

TEST(BandSum, StopsWhereItsHostWants) {
    auto const [model, other] = MakePair();
    BandSumOptions const options{.gains = {400, {}, 1.0}, .from = other};
    EXPECT_TRUE(test::StopsHalfway(
        [&, &mesh = model](engine::Job& job) { engine::SumBands(mesh, options, job); }));
}

}  // namespace
}  // namespace limn
