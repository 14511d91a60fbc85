// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/pinned_function.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "far_ext/forms/hodge_star.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

std::vector<double> MakeFunction(engine::Scene const& scene, std::vector<eval::Pin> const& pins) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const level = refiner->GetLevel(0);
    auto const stars = far_ext::FindHodgeStars(level, scene.positions);
    return eval::MakeHarmonicFunction(level, stars.edge, pins);
}

// On a mesh of acute triangles all weights are positive: a mean of neighbours is no extremum.
TEST(PinnedFunction, MeetsItsPinsAndStaysWithinThem) {
    for (auto const& scene : {test::MakeIcosphere(2), test::MakeTriangleTorus(12, 10)}) {
        std::vector<eval::Pin> const pins{{3, -0.5}, {40, 2.0}, {70, 0.25}};
        auto const values = MakeFunction(scene, pins);
        for (auto const& pin : pins) EXPECT_EQ(values[pin.vertex], pin.value);
        EXPECT_EQ(*std::ranges::min_element(values), -0.5);
        EXPECT_EQ(*std::ranges::max_element(values), 2.0);
    }
}

// A linear function is harmonic: pinned all along a flat mesh's boundary it comes back.
TEST(PinnedFunction, IsLinearOnAPlaneWhoseBoundaryIsLinear) {
    auto const scene = test::MakeLattice(6, 5, Sdc::SCHEME_CATMARK);
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const level = refiner->GetLevel(0);
    auto const exact = [&](Index vertex) {
        return 2.0 * scene.positions[3 * vertex] - 3.0 * scene.positions[3 * vertex + 1];
    };
    std::vector<eval::Pin> pins;
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (level.IsVertexBoundary(vertex)) pins.push_back({vertex, exact(vertex)});
    }
    auto const values = MakeFunction(scene, pins);
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex)
        EXPECT_NEAR(values[vertex], exact(vertex), 1e-12);
}

// A component without pins has none of the function.
TEST(PinnedFunction, IsZeroOnOtherComponents) {
    auto const one = test::MakeIcosphere(1);
    auto const values = MakeFunction(test::Join({one, one}), {{0, 1.0}, {5, 2.0}});
    for (size_t i = values.size() / 2; i < values.size(); ++i) EXPECT_EQ(values[i], 0.0);
}

}  // namespace
}  // namespace limn
