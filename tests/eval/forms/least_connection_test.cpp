// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/least_connection.h"

#include <gtest/gtest.h>

#include "eval/forms/angles.h"
#include "eval/forms/field_index.h"
#include "far_ext/rows/points.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using eval::WantedIndex;

/// Vertices far apart, of valence 6.
std::vector<Index> ChooseVertices(Far::TopologyLevel const& level, size_t count) {
    std::vector<Index> chosen;
    Index const step = level.GetNumVertices() / static_cast<Index>(count);
    for (size_t i = 0; i < count; ++i) {
        Index vertex = static_cast<Index>(i) * step + step / 2;
        while (level.GetVertexEdges(vertex).size() != 6) ++vertex;
        chosen.push_back(vertex);
    }
    return chosen;
}

void ExpectIndices(engine::Scene const& scene, std::vector<int> const& indices) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const level = refiner->GetLevel(0);
    auto const vertices = ChooseVertices(level, indices.size());
    std::vector<WantedIndex> wanted;
    for (size_t i = 0; i < indices.size(); ++i) wanted.push_back({vertices[i], indices[i]});
    auto const form = MakeUnitField(level, scene.positions, wanted);
    auto const found = eval::FindFieldIndices(level, form);
    std::erase_if(wanted, [](WantedIndex const& at) { return at.index == 0; });
    ASSERT_EQ(found.singularities.size(), wanted.size());
    for (size_t i = 0; i < wanted.size(); ++i) {
        EXPECT_FALSE(found.singularities[i].isFace);
        EXPECT_EQ(found.singularities[i].element, wanted[i].vertex);
        EXPECT_EQ(found.singularities[i].index, wanted[i].index);
    }
}

TEST(LeastConnection, IndicesComeOutWhereTheyAreWantedAndNowhereElse) {
    auto const sphere = test::MakeIcosphere(3);
    ExpectIndices(sphere, {1, 1});
    ExpectIndices(sphere, {1, 1, 1, -1});
    ExpectIndices(sphere, {1, 1, 1, 1, -2});
}

// Round handles the field comes back as it was: on a torus one without any singularity.
TEST(LeastConnection, NeedsNoSingularityOnATorus) {
    ExpectIndices(test::MakeTriangleTorus(12, 10), {0});
    ExpectIndices(test::MakeTriangleTorus(12, 10), {1, -1});
}

// Vectors of length 1: along an edge no more than its length.
TEST(LeastConnection, IsNoLongerThanItsEdges) {
    auto const scene = test::MakeIcosphere(2);
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const level = refiner->GetLevel(0);
    auto const form =
        MakeUnitField(level, scene.positions, std::vector<WantedIndex>{{20, 1}, {60, 1}});
    double largest = 0.0;
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const ends = level.GetEdgeVertices(edge);
        far_ext::Points const points(scene.positions);
        double const length = (points[ends[1]] - points[ends[0]]).norm();
        EXPECT_LE(std::abs(form[edge]), length * (1.0 + 1e-12));
        largest = std::max(largest, std::abs(form[edge]) / length);
    }
    EXPECT_GT(largest, 0.99);
}

TEST(Angles, AreThoseOfTheLibrary) {
    for (int i = -1000; i <= 1000; ++i) {
        double const angle = 0.0031 * i;
        auto const unit = eval::MakeUnit(angle);
        EXPECT_NEAR(unit.real(), std::cos(angle), 2e-15);
        EXPECT_NEAR(unit.imag(), std::sin(angle), 2e-15);
        EXPECT_NEAR(eval::FindAngle(3.0 * std::cos(angle), 3.0 * std::sin(angle)), angle, 4e-15);
    }
    EXPECT_EQ(eval::FindAngle(0.0, 0.0), 0.0);
    EXPECT_NEAR(eval::FindAngle(-1.0, 0.0), M_PI, 1e-15);
    EXPECT_NEAR(eval::MakeUnit(100.0).real(), std::cos(100.0), 1e-13);
}

}  // namespace
}  // namespace limn
