// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/field_index.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "support/fit_meshes.h"
#include "support/form_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

using Values = std::vector<double>;

Values AddRounding(Values form) {
    auto const noise = test::MakeNoise(form.size(), 4);
    for (size_t i = 0; i < form.size(); ++i) form[i] += 1e-13 * noise[i];
    return form;
}

// A rotation round an axis through vertices: nothing flows along the spokes there but rounding, of
// any sign, and yet the vertices are the middles.
TEST(FieldIndex, AVortexRoundAVertexIsOne) {
    auto const scene = test::MakeQuadSphere(2);
    auto const refiner = test::MakeRefiner(scene, 0);
    auto const level = refiner->GetLevel(0);
    auto const points = test::ToRows(scene.positions);
    Values form(static_cast<size_t>(level.GetNumEdges()));
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const ends = level.GetEdgeVertices(edge);
        Eigen::Vector3d const a = points.row(std::min(ends[0], ends[1])),
                              b = points.row(std::max(ends[0], ends[1]));
        form[static_cast<size_t>(edge)] = Eigen::Vector3d::UnitZ().dot(a.cross(b));
    }
    auto const indices = eval::FindFieldIndices(level, AddRounding(form));
    ASSERT_EQ(indices.singularities.size(), 2u);
    for (auto const& singularity : indices.singularities) {
        EXPECT_FALSE(singularity.isFace);
        EXPECT_EQ(singularity.index, 1.0);
        EXPECT_NEAR(std::abs(points(singularity.element, 2)), 1.0, 1e-12);
    }
}

// The gradient of y runs straight into two sides of a square and along the others: it is singular
// at its corners at most, whatever the rounding.
TEST(FieldIndex, RoundingAlongABoundaryIsNoSingularity) {
    for (auto scheme : {Sdc::SCHEME_CATMARK, Sdc::SCHEME_LOOP}) {
        auto const scene = test::MakeLattice(6, 5, scheme);
        auto const refiner = test::MakeRefiner(scene, 0);
        auto const level = refiner->GetLevel(0);
        Values const form = test::MakeCoordinateForm(level, scene.positions, 1);
        auto const exact = eval::FindFieldIndices(level, form),
                   rounded = eval::FindFieldIndices(level, AddRounding(form));
        EXPECT_LE(exact.singularities.size(), 4u);
        ASSERT_EQ(rounded.singularities.size(), exact.singularities.size());
        for (size_t i = 0; i < exact.singularities.size(); ++i) {
            EXPECT_EQ(rounded.singularities[i].element, exact.singularities[i].element);
            EXPECT_EQ(rounded.singularities[i].index, exact.singularities[i].index);
        }
        EXPECT_EQ(rounded.sum, 1.0);
    }
}

}  // namespace
}  // namespace limn
