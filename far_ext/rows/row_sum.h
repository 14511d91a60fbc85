// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "far_ext/rows/sparse_rows.h"

namespace limn::far_ext {

/// Weights over control points, as many as there may be round a pole: adding one is no search, as
/// in a WeightRow, and those of equal points meet when the row is finished.
class RowSum {
public:
    void Clear() { _entries.clear(); }

    void Add(Index index, double weight) { _entries.emplace_back(index, weight); }

    /// `weight` times a row of a table.
    void Add(SparseRows const& rows, int row, double weight) {
        for (int k = rows.offsets[row]; k < rows.offsets[row + 1]; ++k)
            Add(rows.indices[k], weight * rows.weights[k]);
    }

    /// Appends the sum to a table, by rising index, without weights that have become 0.
    void AppendTo(SparseRows& rows) {
        std::ranges::stable_sort(_entries, {}, &Entry::first);  // sums do not depend on the sort
        for (size_t i = 0; i < _entries.size();) {
            auto [index, weight] = _entries[i++];
            while (i < _entries.size() && _entries[i].first == index)
                weight += _entries[i++].second;
            if (weight == 0.0) continue;
            rows.indices.push_back(index);
            rows.weights.push_back(weight);
        }
        rows.offsets.push_back(static_cast<int>(rows.indices.size()));
    }

private:
    using Entry = std::pair<Index, double>;

    std::vector<Entry> _entries;
};

}  // namespace limn::far_ext
