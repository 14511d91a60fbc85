// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limn::bench {

/// A plain loop over the rows of a table with Far's accessors, three floats per point: what -O3
/// makes of it without any thought about the layout.
template <class Table>
void EvaluatePlainRows(Table const& table, float const* source, float* target) {
    int const* const sizes = table.GetSizes().data();
    int const* indices = table.GetControlIndices().data();
    float const* weights = table.GetWeights().data();
    for (int row = 0; row < table.GetNumStencils(); ++row, target += 3) {
        float x = 0.0f, y = 0.0f, z = 0.0f;
        for (int k = 0; k < sizes[row]; ++k) {
            float const* const point = source + 3 * static_cast<long>(*indices++);
            float const weight = *weights++;
            x += weight * point[0];
            y += weight * point[1];
            z += weight * point[2];
        }
        target[0] = x;
        target[1] = y;
        target[2] = z;
    }
}

}  // namespace limn::bench
