// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/dirmag.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "eval/differential/reconstruct.h"
#include "eval/differential/subdivide_values.h"
#include "far_ext/differential/laplacian.h"
#include "support/refined.h"

namespace limn {
namespace {

using far_ext::SubdivisionRule;

struct DirMagReference {
    char const *mesh, *rule;
    SubdivisionRule subdivision;
};

class DirMagOf : public testing::TestWithParam<DirMagReference> {};
INSTANTIATE_TEST_SUITE_P(
    References, DirMagOf,
    testing::Values(DirMagReference{"icosa", "loop", SubdivisionRule::Scheme},
                    DirMagReference{"icosa", "butterfly", SubdivisionRule::Butterfly},
                    DirMagReference{"torustri", "loop", SubdivisionRule::Scheme},
                    DirMagReference{"torustri", "butterfly", SubdivisionRule::Butterfly}));

// The first level by direction and magnitude, the second linearly, then reconstruction.
TEST_P(DirMagOf, TheReferenceIsMet) {
    auto const& [mesh, rule, subdivision] = GetParam();
    auto const scene = test::LoadDifferential(mesh, Sdc::SCHEME_LOOP);
    auto const refiner = test::MakeRefiner(scene, 2);
    auto const base =
        test::Apply(far_ext::BuildCombinatorialLaplacian(refiner->GetLevel(0)), scene.positions);
    auto const split = eval::SplitDirMag(refiner->GetLevel(0), scene.positions, base);
    auto const rows = far_ext::BuildSubdivisionRows(*refiner, 1, subdivision);
    auto deltas = eval::JoinDirMag(eval::SubdivideDirMag(rows, split));
    deltas = eval::SubdivideValues<3>(*refiner, 2, subdivision, deltas);
    for (double& delta : deltas) delta /= 16.0;
    std::vector<double> positions(deltas.size(), 0.0);
    eval::Reconstructor(*refiner).Solve(deltas, positions, {.tolerance = 1e-12});
    auto const reference =
        test::LoadPoints(fmt::format("differential/{}_dss_{}_dm1_L2.obj", mesh, rule));
    EXPECT_LT(test::LargestDifference(positions, reference, true),
              1e-8 * test::BoxDiagonal(scene.positions));
}

// [Zhu11] Fig. 5: of coordinates that are equally long, linear means are shorter, which makes
// waves.
TEST(DirMag, EqualMagnitudesStayEqualWhereLinearMeansGetShorter) {
    auto const scene = test::LoadDifferential("icosa", Sdc::SCHEME_LOOP);
    auto const refiner = test::MakeRefiner(scene, 1);
    auto const deltas =
        test::Apply(far_ext::BuildCombinatorialLaplacian(refiner->GetLevel(0)), scene.positions);
    auto const split = eval::SplitDirMag(refiner->GetLevel(0), scene.positions, deltas);
    auto const rows = far_ext::BuildSubdivisionRows(*refiner, 1, SubdivisionRule::Butterfly);
    auto const fine = eval::SubdivideDirMag(rows, split).magnitudes;
    auto const linear = test::Apply(rows, deltas);
    double const length = split.magnitudes[0];
    for (size_t i = 0; i < fine.size(); ++i) {
        EXPECT_NEAR(fine[i], length, 1e-9 * length);
        Eigen::Map<Eigen::Vector3d const> const mean(&linear[3 * i]);
        if (i < split.magnitudes.size())
            EXPECT_NEAR(mean.norm(), length, 1e-9 * length);
        else
            EXPECT_LT(mean.norm(), 0.99 * length);
    }
}

TEST(DirMag, ThePartsMakeTheWhole) {
    auto const scene = test::MakeFan(5, Sdc::SCHEME_LOOP, 0.2, 0.3);
    auto const refiner = test::MakeRefiner(scene, 0);
    auto const deltas =
        test::Apply(far_ext::BuildCombinatorialLaplacian(refiner->GetLevel(0)), scene.positions);
    auto const split = eval::SplitDirMag(refiner->GetLevel(0), scene.positions, deltas);
    EXPECT_LT(test::LargestDifference(eval::JoinDirMag(split), deltas), 1e-14);
}

// The tangential share of a triangulated torus is the one that the method was found to bear.
TEST(DirMag, TheTangentialShareIsMeasured) {
    auto const scene = test::LoadDifferential("torustri", Sdc::SCHEME_LOOP);
    auto const refiner = test::MakeRefiner(scene, 0);
    auto const deltas =
        test::Apply(far_ext::BuildCombinatorialLaplacian(refiner->GetLevel(0)), scene.positions);
    EXPECT_NEAR(eval::SplitDirMag(refiner->GetLevel(0), scene.positions, deltas).tangentialShare,
                0.51, 0.02);
}

/// 7 x 7 points a third apart, flat but for one, moved along all axes.
engine::Scene MakeBumpedPlane(double offset) {
    std::vector<double> positions;
    std::vector<std::vector<Index>> faces;
    for (int i = 0; i < 49; ++i) {
        double const x = i % 7 / 3.0, y = i / 7 / 3.0, z = i == 16 ? 0.5 : 0.0;
        positions.insert(positions.end(), {x + offset, y + offset, z + offset});
        if (i % 7 < 6 && i < 42) faces.push_back({i, i + 1, i + 8, i + 7});
    }
    return test::MakeScene(std::move(positions), faces, Sdc::SCHEME_CATMARK);
}

// Far from the origin a flat vertex' coordinate is rounding, which points anywhere; its direction
// is the normal as before, so that means with its neighbours stay what they were.
TEST(DirMag, FlatVerticesTakeTheNormalWhereverTheyAre) {
    auto const split = [](double offset) {
        auto const scene = MakeBumpedPlane(offset);
        auto const refiner = test::MakeRefiner(scene, 0);
        auto const level = refiner->GetLevel(0);
        return eval::SplitDirMag(
            level, scene.positions,
            far_ext::FindDeltas(far_ext::BuildCombinatorialLaplacian(level), scene.positions));
    };
    auto const here = split(0.0), there = split(1e4 / 3.0);
    EXPECT_LT(test::LargestDifference(here.directions, there.directions), 1e-9);
    size_t const flat = 3 * 40;
    EXPECT_EQ(std::abs(here.directions[flat + 2]), 1.0);
}

// Directions that cancel have no mean: the one of the largest weight stays, and nothing is not a
// number.
TEST(DirMag, OppositeDirectionsHaveAnAnswer) {
    far_ext::SparseRows rows;
    far_ext::WeightRow row;
    row.Add(0, 0.5);
    row.Add(1, 0.5);
    rows.AddRow(row);
    auto const mean = eval::SubdivideDirMag(rows, {{1.0, 3.0}, {0, 0, 1, 0, 0, -1}, 0.0});
    EXPECT_EQ(mean.directions, (std::vector<double>{0, 0, 1}));
    EXPECT_EQ(mean.magnitudes, std::vector<double>{2.0});
}

}  // namespace
}  // namespace limn
