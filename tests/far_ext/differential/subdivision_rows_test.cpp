// SPDX-License-Identifier: Apache-2.0
#include "far_ext/differential/subdivision_rows.h"

#include <gtest/gtest.h>

#include "support/fit_meshes.h"
#include "support/refined.h"

namespace limn {
namespace {

// A scheme's table is what OpenSubdiv does to values.
TEST(SubdivisionRows, OfTheSchemeAreOpenSubdivs) {
    for (auto const& scene : {test::MakeCube(), test::MakeBipyramid(7),
                              test::MakeFan(5, Sdc::SCHEME_CATMARK, 0.1, 0.2)}) {
        auto const refiner = test::MakeRefiner(scene, 2);
        auto const rows =
            far_ext::BuildSubdivisionRows(*refiner, 1, far_ext::SubdivisionRule::Scheme);
        auto const fine = test::Apply(rows, scene.positions);
        EXPECT_LT(
            test::LargestDifference(fine, eval::RefineValues<3>(*refiner, 1, scene.positions)),
            1e-15);
    }
}

}  // namespace
}  // namespace limn
