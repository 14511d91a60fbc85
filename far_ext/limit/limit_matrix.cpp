// SPDX-License-Identifier: Apache-2.0
#include "far_ext/limit/limit_matrix.h"

#include <limits>

#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::far_ext {

LimitMatrix LimitMatrix::Build(Far::TopologyRefiner const& refiner, int level,
                               LimitOptions const& options) {
    LimitRowBuilder builder(refiner, level, options);
    Index const numVertices = builder.GetNumVertices();
    size_t const size = numVertices;

    LimitMatrix matrix;
    auto& [offsets, indices, weights] = matrix._rows;
    offsets.reserve(size + 1);
    indices.reserve(9 * size);  // what a regular vertex among quads needs
    weights.reserve(9 * size);
    matrix._sizes.reserve(size);
    matrix._scales.reserve(size);
    std::vector<int> place(size, -1);  // of a column in the row that used it last
    LimitRow row;
    for (Index vertex = 0; vertex < numVertices; ++vertex) {
        builder.Build(vertex, row);
        int const start = offsets.back();
        auto const add = [&](Index column, double weight) {
            if (place[column] >= start) {
                weights[place[column]] += weight;
                return;
            }
            place[column] = static_cast<int>(indices.size());
            indices.push_back(column);
            weights.push_back(weight);
        };
        add(vertex, row.centre);
        for (size_t k = 0; k < row.indices.size(); ++k) add(row.indices[k], row.GetWeight(k));
        if (indices.size() > static_cast<size_t>(std::numeric_limits<int>::max())) {
            throw Error(
                ErrorCode::TooLarge,
                fmt::format("the limit matrix of {} vertices passes 2^31 entries", numVertices));
        }
        offsets.push_back(static_cast<int>(indices.size()));
        matrix._sizes.push_back(offsets.back() - start);
        matrix._scales.push_back(row.scale);
    }
    return matrix;
}

LimitMatrix::Matrix LimitMatrix::AsMatrix() const {
    return far_ext::AsMatrix(_rows, _rows.GetNumRows());
}

}  // namespace limn::far_ext
