// SPDX-License-Identifier: Apache-2.0
#include "far_ext/differential/butterfly.h"

#include <numeric>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

class ButterflyOf : public testing::TestWithParam<char const*> {};
INSTANTIATE_TEST_SUITE_P(References, ButterflyOf,
                         testing::Values("icosa", "torustri", "gridholetri"));

// Two steps of an independent implementation: valence 5, regular, boundaries.
TEST_P(ButterflyOf, TheReferenceIsMet) {
    auto const scene = test::LoadDifferential(GetParam(), Sdc::SCHEME_LOOP);
    auto const refiner = test::MakeRefiner(scene, 2);
    auto points = scene.positions;
    for (int level : {1, 2}) points = test::Apply(far_ext::BuildButterfly(*refiner, level), points);
    auto const reference =
        test::LoadPoints(fmt::format("differential/{}_sub_butterfly_L2.obj", GetParam()));
    EXPECT_LT(test::LargestDifference(points, reference),
              1e-13 * test::BoxDiagonal(scene.positions));
}

class ButterflyAt : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Valences, ButterflyAt, testing::Range(3, 13));

TEST_P(ButterflyAt, RowsSumToOneAndVerticesStay) {
    auto const scene = test::MakeBipyramid(GetParam());
    auto const refiner = test::MakeRefiner(scene, 1);
    auto const rows = far_ext::BuildButterfly(*refiner, 1);
    for (int row = 0; row < rows.GetNumRows(); ++row) {
        EXPECT_NEAR(std::accumulate(rows.weights.begin() + rows.offsets[row],
                                    rows.weights.begin() + rows.offsets[row + 1], 0.0),
                    1.0, 1e-15);
    }
    auto const fine = test::Apply(rows, scene.positions);
    for (size_t i = 0; i < scene.positions.size(); ++i) EXPECT_EQ(fine[i], scene.positions[i]);
}

// On a flat regular grid the rule has cubic precision inside: a quadratic height is met.
TEST(Butterfly, QuadraticsAreMetOnARegularGrid) {
    auto const scene = test::MakeFan(6, Sdc::SCHEME_LOOP, 0.3, 0.2);
    auto const refiner = test::MakeRefiner(scene, 1);
    auto const fine = test::Apply(far_ext::BuildButterfly(*refiner, 1), scene.positions);
    auto const coarse = refiner->GetLevel(0);
    for (Index edge : coarse.GetVertexEdges(0)) {  // edges whose whole stencil lies inside
        double const* const p = &fine[3 * static_cast<size_t>(coarse.GetEdgeChildVertex(edge))];
        EXPECT_NEAR(p[2], 0.5 * p[0] * p[0] + 0.1 * p[1] * p[1], 1e-14);
    }
}

TEST(Butterfly, ThreeFacesAtAnEdgeAreRefused) {
    auto const scene = test::MakeScene({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1},
                                       {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, Sdc::SCHEME_LOOP);
    auto const refiner = test::MakeRefiner(scene, 1);
    EXPECT_NE(test::RefusalOf([&] { far_ext::BuildButterfly(*refiner, 1); }), "");
}

// Its rows are those of a Loop refinement, which has other vertices than this one.
TEST(Butterfly, AnotherSchemeIsRefused) {
    auto const scene =
        test::MakeScene({0, 0, 0, 1, 0, 0, 0, 1, 0}, {{0, 1, 2}}, Sdc::SCHEME_CATMARK);
    auto const refiner = test::MakeRefiner(scene, 1);
    EXPECT_EQ(test::CodeOf([&] { far_ext::BuildButterfly(*refiner, 1); }), ErrorCode::Unsupported);
}

}  // namespace
}  // namespace limn
