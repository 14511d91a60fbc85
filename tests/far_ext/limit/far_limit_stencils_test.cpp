// SPDX-License-Identifier: Apache-2.0
#include "far_ext/limit/far_limit_stencils.h"

#include <cmath>

#include <gtest/gtest.h>

#include "far_ext/error.h"
#include "support/fit_meshes.h"
#include "support/meshes.h"

namespace limn {
namespace {

using far_ext::BuildFarLimitStencils;
using far_ext::EndCap;
using far_ext::PtexPlace;

std::vector<PtexPlace> ListPlaces(Index numPtexFaces, double s, double t) {
    std::vector<PtexPlace> places;
    for (Index face = 0; face < numPtexFaces; ++face) places.push_back({face, s, t});
    return places;
}

TEST(FarLimitStencils, RowsOfValuesAddUpToOneAndThoseOfDerivativesToNothing) {
    for (auto const& scene : {test::LoadSpot(), test::MakeIcosphere(1), test::MakeCube()}) {
        for (EndCap cap : {EndCap::Gregory, EndCap::BSpline}) {
            auto const stencils =
                BuildFarLimitStencils(scene.cage, ListPlaces(scene.cage.GetNumFaces(), 0.3, 0.4),
                                      {.level = 3, .endCap = cap});
            auto const view = stencils.rows.GetView();
            ASSERT_EQ(view.numRows, scene.cage.GetNumFaces());
            ASSERT_EQ(view.numSets, 6);
            for (Index row = 0; row < view.numRows; ++row) {
                for (size_t set = 0; set < 6; ++set) {
                    double sum = 0.0, size = 0.0;
                    for (int k = 0; k < view.sizes[row]; ++k) {
                        double const weight = view.weights[set][view.offsets[row] + k];
                        sum += weight;
                        size += std::abs(weight);
                    }
                    EXPECT_NEAR(sum, set == 0 ? 1.0 : 0.0, 1e-5 * (1.0 + size)) << set;
                }
            }
        }
    }
}

TEST(FarLimitStencils, AHoleHasNoRow) {
    auto scene = test::MakeTorus(5, 4);
    scene.cage.holes = {7};
    auto const stencils = BuildFarLimitStencils(scene.cage, ListPlaces(20, 0.5, 0.5), {});
    for (int face = 0; face < 20; ++face)
        EXPECT_EQ(stencils.rowOfPlace[static_cast<size_t>(face)], face < 7    ? face
                                                                  : face == 7 ? -1
                                                                              : face - 1);
    EXPECT_EQ(stencils.rows.GetNumStencils(), 19);
}

TEST(FarLimitStencils, NoPlaceMakesAnEmptyTable) {
    EXPECT_EQ(BuildFarLimitStencils(test::MakeCube().cage, {}, {}).rows.GetNumStencils(), 0);
}

TEST(FarLimitStencils, ALevelThatOpenSubdivHasNotIsRefused) {
    for (int level : {0, -1, 11, 16}) {
        EXPECT_THROW(BuildFarLimitStencils(test::MakeCube().cage, {}, {.level = level}), Error)
            << level;
    }
}

}  // namespace
}  // namespace limn
