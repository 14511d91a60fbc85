// SPDX-License-Identifier: Apache-2.0
#include "far_ext/forms/hodge_star.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "support/form_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

// Worked out by hand: equilateral triangles, a square as two triangles, unit squares.
TEST(HodgeStars, AreTheRatiosOfDualToEdge) {
    double const h = std::sqrt(3.0) / 2.0;
    auto const find = [](engine::Scene const& scene) {
        return far_ext::FindHodgeStars(test::MakeRefiner(scene, 0)->GetLevel(0), scene.positions);
    };
    auto const rhombus = find(test::MakeScene({0, 0, 0, 1, 0, 0, 0.5, h, 0, 1.5, h, 0},
                                              {{0, 1, 2}, {1, 3, 2}}, Sdc::SCHEME_LOOP));
    // In the order in which faces meet them: 01, 12 (of both), 20, 13, 32.
    double const expected[] = {0.5, 1.0, 0.5, 0.5, 0.5};
    for (size_t e = 0; e < 5; ++e)
        EXPECT_NEAR(rhombus.edge[e], expected[e] / std::sqrt(3.0), 1e-14);
    for (double area : rhombus.area) EXPECT_NEAR(area, h / 2.0, 1e-14);
    auto const square =
        find(test::MakeLattice(1, 1, Sdc::SCHEME_LOOP));  // the diagonal sees right angles only
    double const mean = (4 * 0.5 + 0.0) / 5.0;
    EXPECT_NEAR(*std::min_element(square.edge.begin(), square.edge.end()), 1e-3 * mean, 1e-14);
    EXPECT_NEAR(*std::max_element(square.edge.begin(), square.edge.end()), 0.5, 1e-14);
    auto const grid = find(test::MakeLattice(2, 2, Sdc::SCHEME_CATMARK));
    for (double star : grid.edge)
        EXPECT_TRUE(std::abs(star - 1.0) < 1e-14 || std::abs(star - 0.5) < 1e-14)
            << star;  // inside, on the border
    EXPECT_NEAR(std::accumulate(grid.edge.begin(), grid.edge.end(), 0.0), 4 * 1.0 + 8 * 0.5, 1e-13);
}

}  // namespace
}  // namespace limn
