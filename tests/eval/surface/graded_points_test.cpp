// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/graded_points.h"

#include <gtest/gtest.h>

#include "far_ext/topology/refiner.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"

namespace limn {
namespace {

// The pieces are all of a domain.
TEST(GradedPoints, WeightsAddUpToTheDomain) {
    for (auto const& [scene, area] :
         {std::pair{test::MakeCube(), 1.0}, {test::MakeBipyramid(7), 0.5}}) {
        auto const refiner = far_ext::CreateRefiner(scene.cage);
        eval::LimitSurface const surface(*refiner);
        eval::GradedPoints const points(surface);
        double sum = 0.0;
        points.ForEach(0, [&](eval::SurfacePlace const& place, double weight) {
            sum += weight;
            EXPECT_TRUE(place.s > 0.0 && place.t > 0.0 && place.s < 1.0 && place.t < 1.0);
        });
        EXPECT_NEAR(sum, area, 1e-12);
    }
}

}  // namespace
}  // namespace limn
