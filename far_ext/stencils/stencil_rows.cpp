// SPDX-License-Identifier: Apache-2.0
#include "far_ext/stencils/stencil_rows.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::far_ext {

void StencilRows::EndRow() {
    if (_indices.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max())) {
        throw Error(ErrorCode::TooLarge, "a stencil table passes 2^31 entries");
    }
    Index const begin = _sizes.empty() ? 0 : _offsets.back() + _sizes.back();
    _offsets.push_back(begin);
    _sizes.push_back(static_cast<int>(_indices.size()) - begin);
}

void Validate(StencilRowsView const& rows) {
    auto const refuse = [](std::string const& message) {
        throw Error(ErrorCode::BadMesh, message);
    };
    auto const require = [&](bool isThere) {
        if (isThere) return;
        refuse(
            "the stencil table lacks sizes, offsets, indices or weights (Far makes offsets with "
            "generateOffsets)");
    };
    require(rows.numRows == 0 || (rows.sizes && rows.offsets));
    for (Index row = 0; row < rows.numRows; ++row) {
        Index const begin = rows.offsets[row];
        int const size = rows.sizes[row];
        require(size == 0 || (rows.indices && rows.weights[0]));
        if (begin < 0 || size < 0) {
            refuse(fmt::format("stencil {} has offset {} and size {}; neither may be negative", row,
                               begin, size));
        }
        for (Index k = begin; k < begin + size; ++k) {
            if (rows.indices[k] < 0 || rows.indices[k] >= rows.numControls) {
                refuse(fmt::format("stencil {} names control vertex {}; there are {}", row,
                                   rows.indices[k], rows.numControls));
            }
            for (int set = 0; set < rows.numSets; ++set) {
                if (!std::isfinite(rows.weights[set][k])) {
                    refuse(fmt::format(
                        "stencil {} has the weight {} at control vertex {}; weights are finite",
                        row, rows.weights[set][k], rows.indices[k]));
                }
            }
        }
    }
}

}  // namespace limn::far_ext
