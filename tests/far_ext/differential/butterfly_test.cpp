// SPDX-License-Identifier: Apache-2.0
#include "far_ext/differential/butterfly.h"

#include <map>
#include <numeric>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/fit_meshes.h"
#include "support/form_meshes.h"
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

// The same eight points at every valence, whatever w: 1/2, 2w, -w.
TEST(Butterfly, TheOriginalHasOneMaskAtAllValences) {
    constexpr double w = 0.03;
    for (int n : {5, 7, 12}) {
        auto const scene = test::MakeFan(n, Sdc::SCHEME_LOOP, 0.3, 0.2);
        auto const refiner = test::MakeRefiner(scene, 1);
        auto const coarse = refiner->GetLevel(0);
        auto const rows = far_ext::BuildOriginalButterfly(*refiner, 1, w);
        for (Index edge : coarse.GetVertexEdges(0)) {
            Index const child = coarse.GetEdgeChildVertex(edge);
            std::map<double, int> counts;
            for (int k = rows.offsets[child]; k < rows.offsets[child + 1]; ++k)
                ++counts[rows.weights[k]];
            EXPECT_EQ(counts, (std::map<double, int>{{0.5, 2}, {2 * w, 2}, {-w, 4}}));
        }
    }
}

// Where all valences are 6 both rules are one, boundaries included.
TEST(Butterfly, TheOriginalIsTheModifiedOneOnRegularMeshes) {
    for (auto const& scene :
         {test::MakeTriangleTorus(7, 6), test::MakeLattice(5, 4, Sdc::SCHEME_LOOP)}) {
        auto const refiner = test::MakeRefiner(scene, 1);
        EXPECT_EQ(
            test::Apply(far_ext::BuildOriginalButterfly(*refiner, 1, 1.0 / 16), scene.positions),
            test::Apply(far_ext::BuildButterfly(*refiner, 1), scene.positions));
    }
}

// (-w, 1/2 + w, 1/2 + w, -w) along the boundary: a parabola's height at the middle of an edge
// of length 1 is 1/4 - 4w too high, the same for all of them.
TEST(Butterfly, TheOriginalsBoundariesHaveTheTension) {
    auto scene = test::MakeLattice(5, 4, Sdc::SCHEME_LOOP);
    for (size_t i = 0; i < scene.positions.size(); i += 3)
        scene.positions[i + 2] = scene.positions[i] * scene.positions[i];
    auto const refiner = test::MakeRefiner(scene, 1);
    for (double w : {0.0, 1.0 / 32, 1.0 / 8}) {
        auto const fine =
            test::Apply(far_ext::BuildOriginalButterfly(*refiner, 1, w), scene.positions);
        auto const coarse = refiner->GetLevel(0);
        Index const edge = coarse.FindEdge(2, 3);
        double const* const p = &fine[3 * static_cast<size_t>(coarse.GetEdgeChildVertex(edge))];
        EXPECT_DOUBLE_EQ(p[0], 2.5);
        EXPECT_DOUBLE_EQ(p[2], 2.5 * 2.5 + 0.25 - 4.0 * w);
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
