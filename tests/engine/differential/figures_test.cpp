// SPDX-License-Identifier: Apache-2.0
//
// What figures of [Zhu11] show, where their text says it in numbers.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/differential/differential.h"
#include "eval/differential/mesh_curvature.h"
#include "support/refined.h"

namespace limn {
namespace {

/// A drum with a convex vertex of valence 12 at the top, and one below.
engine::Scene MakeDrum() {
    constexpr Index n = 12;
    std::vector<double> positions{0.0, 0.0, 1.0};
    std::vector<std::vector<Index>> faces;
    for (Index ring = 0; ring < 3; ++ring) {
        double const z = 0.6 * (1 - ring), radius = ring == 1 ? 1.0 : 0.8;
        for (Index i = 0; i < n; ++i) {
            double const angle = (i + 0.5 * ring) * std::acos(-1.0) / 6.0;
            positions.insert(positions.end(),
                             {radius * std::cos(angle), radius * std::sin(angle), z});
        }
    }
    positions.insert(positions.end(), {0.0, 0.0, -1.0});
    for (Index i = 0; i < n; ++i) {
        Index const next = (i + 1) % n, a = 1 + i, b = 1 + next;
        faces.push_back({0, a, b});
        for (Index ring = 0; ring < 2 * n; ring += n) {
            faces.push_back({a + ring, a + ring + n, b + ring});
            faces.push_back({b + ring, a + ring + n, b + ring + n});
        }
        faces.push_back({3 * n + 1, b + 2 * n, a + 2 * n});
    }
    return test::MakeScene(std::move(positions), faces, Sdc::SCHEME_LOOP);
}

/// The least and the largest Gaussian curvature of a mesh round its top, but not at it.
std::pair<double, double> FindRangeRoundTheTop(engine::Scene const& mesh) {
    auto const refiner = test::MakeRefiner(mesh, 0);
    auto const curvature = eval::MeasureMeshCurvature(refiner->GetLevel(0), mesh.positions);
    double least = INFINITY, largest = -INFINITY;
    for (size_t i = 0; 3 * i < mesh.positions.size(); ++i) {
        double const radius = std::hypot(mesh.positions[3 * i], mesh.positions[3 * i + 1]);
        if (mesh.positions[3 * i + 2] < 0.0 || radius < 1e-6 || radius > 0.6) continue;
        least = std::min(least, curvature.GetGaussian(i));
        largest = std::max(largest, curvature.GetGaussian(i));
    }
    return {least, largest};
}

// Fig. 9: ripples in space, curvatures that are all positive and small in differential space.
TEST(FiguresOfZhu11, GaussianCurvatureRoundValenceTwelveIsPositiveAndSmall) {
    auto const drum = MakeDrum();
    engine::DifferentialOptions options;
    options.rule = far_ext::SubdivisionRule::Butterfly;
    options.levels = 3;
    engine::Job job;
    auto const differential = FindRangeRoundTheTop(
        engine::RefineDifferentially(engine::Model::Build(drum), options, job).mesh);
    options.spatialLevels = options.levels;  // none in differential space
    auto const spatial = FindRangeRoundTheTop(
        engine::RefineDifferentially(engine::Model::Build(drum), options, job).mesh);
    EXPECT_LT(spatial.first, 0.0);
    EXPECT_GT(differential.first, 0.0);
    EXPECT_LT(4.0 * differential.second, spatial.second);
}

}  // namespace
}  // namespace limn
