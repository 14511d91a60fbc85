// SPDX-License-Identifier: Apache-2.0
#include "far_ext/cascade/cascade_stencils.h"

#include <limits>

#include "far_ext/error.h"

namespace limn::far_ext {

template <class Weight>
BasicCascadeStencils<Weight>::BasicCascadeStencils(CascadeLevel const& level) {
    Index const numRows = level.GetNumRows();
    size_t const numEntries = level.neighbours.size() + numRows + level.numUnknowns;
    if (numEntries > static_cast<size_t>(std::numeric_limits<int>::max()) ||
        numRows > std::numeric_limits<int>::max() / 2) {
        throw Error(ErrorCode::TooLarge,
                    "a table of sweeps would have more than 2^31 entries; use fewer levels");
    }
    _indices.reserve(numEntries);
    for (Index row = 0; row < numRows; ++row) {
        _offsets.push_back(static_cast<Index>(_indices.size()));
        _indices.push_back(row);
        if (row < level.numUnknowns) {
            _indices.insert(_indices.end(), level.neighbours.begin() + level.offsets[row],
                            level.neighbours.begin() + level.offsets[row + 1]);
            _indices.push_back(numRows + row);
        }
        _sizes.push_back(static_cast<int>(_indices.size()) - _offsets.back());
    }
    _weights.assign(_indices.size(), Weight(1));  // what rows that stay have
}

template <class Weight>
void BasicCascadeStencils<Weight>::SetWeights(CascadeLevel const& level,
                                              std::span<Weight const> edges,
                                              std::span<Weight const> masses,
                                              std::span<Weight const> scales) {
    for (Index row = 0; row < level.numUnknowns; ++row) {
        Weight* weight = &_weights[_offsets[row]];
        Weight& own = *weight++;
        Weight sum = masses[row];
        for (int k = level.offsets[row]; k < level.offsets[row + 1]; ++k) {
            sum += edges[k];
            *weight++ = scales[row] * edges[k];
        }
        own = Weight(1) - scales[row] * sum;
        *weight = scales[row] * masses[row];
    }
}

template class BasicCascadeStencils<float>;
template class BasicCascadeStencils<double>;

}  // namespace limn::far_ext
