// SPDX-License-Identifier: Apache-2.0
#include "far_ext/cascade/cascade_stencils.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "support/cascade_meshes.h"

namespace limn {
namespace {

using far_ext::BoundaryRule;

// 1 - s (m + sum e) + s sum e + s m = 1 in every row, whatever the weights: X = X0 = constant
// stays. Rows that stay are themselves.
TEST(CascadeStencils, RowsAddUpToOne) {
    for (auto rule : {BoundaryRule::Fixed, BoundaryRule::Natural}) {
        for (auto const& [name, scene] : test::GetCascadeMeshes()) {
            if (scene.cage.GetNumFaces() > 300) continue;
            auto const levels = test::QuarterLevels(scene, 1, rule);
            auto const& level = levels.back();
            std::mt19937 random(3);
            auto const draw = [&](size_t count) {
                std::vector<float> values(count);
                for (float& value : values) value = static_cast<float>(random()) * 0x1p-32f;
                return values;
            };
            far_ext::CascadeStencils table(level);
            auto const edges = draw(level.neighbours.size());
            auto scales = draw(static_cast<size_t>(level.numUnknowns));
            if (!scales.empty()) scales[0] = 0.0f;  // one that nothing moves
            table.SetWeights(level, edges, draw(scales.size()), scales);
            ASSERT_EQ(table.GetNumStencils(), level.GetNumRows());
            ASSERT_EQ(table.GetNumControlVertices(), 2 * level.GetNumRows());
            size_t at = 0;
            for (Index row = 0; row < table.GetNumStencils(); ++row) {
                ASSERT_EQ(table.GetOffsets()[row], static_cast<Index>(at)) << name;
                double sum = 0.0, largest = 0.0;
                bool isItself = true;
                for (int k = 0; k < table.GetSizes()[row]; ++k, ++at) {
                    double const weight = table.GetWeights()[at];
                    Index const index = table.GetControlIndices()[at];
                    ASSERT_GE(index, 0);
                    ASSERT_LT(index, table.GetNumControlVertices());
                    sum += weight;
                    largest = std::max(largest, std::abs(weight));
                    isItself = isItself && weight == (index == row ? 1.0 : 0.0);
                }
                EXPECT_NEAR(sum, 1.0, 1e-6 * largest) << name;
                EXPECT_EQ(isItself, row >= level.numUnknowns || row == 0) << name;
            }
            EXPECT_EQ(at, table.GetWeights().size());
        }
    }
}

}  // namespace
}  // namespace limn
