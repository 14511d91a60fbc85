// SPDX-License-Identifier: Apache-2.0
#include "engine/images/picture_view.h"

#include <vector>

#include <gtest/gtest.h>

#include "support/errors.h"

namespace limn {
namespace {

using engine::PictureCamera;
using Vector = Eigen::Vector3d;

// What is included fills 94 % of the square, in the middle, y upwards.
TEST(PictureCamera, FitsWhatIsIncluded) {
    PictureCamera camera({{0.0, 0.0, 1.0}}, 100);
    camera.Include({10.0, 1.0, 5.0});
    camera.Include({14.0, 2.0, -5.0});
    camera.Fit();
    EXPECT_DOUBLE_EQ(camera.GetScale(), 94.0 / 4.0);
    EXPECT_TRUE(camera.Project({10.0, 1.5, 7.0}).isApprox(Vector(3.0, 50.0, 7.0)));
    EXPECT_LT(camera.Project({12.0, 2.0, 0.0}).y(), 50.0);
}

// Looking along y there is no y to stand upright.
TEST(PictureCamera, UpIsYUnlessThatIsLookedAlong) {
    EXPECT_GT(PictureCamera({{1.0, 0.5, 1.0}}, 10).GetUp().y(), 0.5);
    EXPECT_NEAR(PictureCamera({{0.0, 1.0, 0.0}}, 10).GetUp().z(), 1.0, 1e-12);
}

TEST(PictureCamera, BothSidesOfASheetAreLit) {
    PictureCamera const camera({{1.0, 0.6, 0.8}}, 10);
    Vector const normal = Vector(0.2, 0.9, 0.4).normalized();
    EXPECT_DOUBLE_EQ(camera.Shade(normal), camera.Shade(-normal));
    EXPECT_GE(camera.Shade(Vector(1.0, -0.9, -0.2).normalized()), 0.25);
    EXPECT_LE(camera.Shade(normal), 0.95);
}

TEST(PictureCamera, AViewNeedsADirection) {
    EXPECT_EQ(test::CodeOf([] { PictureCamera camera({{0.0, 0.0, 0.0}}, 10); }),
              ErrorCode::BadOption);
}

// Two halves of a square leave no pixel out, and none outside is visited; the weights give back
// where a pixel's centre is.
TEST(ForEachPixel, HalvesOfASquareCoverIt) {
    Vector const a(2.0, 3.0, 0.0), b(12.0, 3.0, 0.0), c(12.0, 9.0, 0.0), d(2.0, 9.0, 0.0);
    std::vector<int> visits(20 * 20, 0);
    for (auto const& corners : {std::array{a, b, c}, std::array{a, c, d}}) {
        engine::ForEachPixel(20, corners, [&](int x, int y, Vector const& weights) {
            ++visits[static_cast<size_t>(20 * y + x)];
            Vector const place =
                weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
            EXPECT_NEAR(place.x(), x + 0.5, 1e-9);
            EXPECT_NEAR(place.y(), y + 0.5, 1e-9);
        });
    }
    for (int y = 0; y < 20; ++y) {
        for (int x = 0; x < 20; ++x) {
            bool const isInside = x >= 2 && x < 12 && y >= 3 && y < 9;
            EXPECT_EQ(visits[static_cast<size_t>(20 * y + x)] > 0, isInside) << x << " " << y;
        }
    }
}

}  // namespace
}  // namespace limn
