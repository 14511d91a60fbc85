// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "far_ext/rows/mix.h"
#include "far_ext/stencils/stencil_groups.h"

namespace limn::far_ext {

namespace {

/// Rows that use the same control vertices (or, next to never, whose controls share a hash),
/// ordered by the first of each set.
std::vector<std::vector<Index>> FindRowsWithSameControls(StencilRowsView const& rows,
                                                         size_t leastRows,
                                                         std::vector<Index>& others) {
    std::vector<std::pair<uint64_t, Index>> keys(rows.numRows);
    for (Index row = 0; row < rows.numRows; ++row) {
        uint64_t hash =
            static_cast<uint64_t>(rows.sizes[row]);  // whatever the order of the controls
        for (int k = 0; k < rows.sizes[row]; ++k) {
            hash += Mix(static_cast<uint64_t>(rows.indices[rows.offsets[row] + k]) + 1);
        }
        keys[row] = {hash, row};
    }
    std::sort(keys.begin(), keys.end());
    std::vector<std::vector<Index>> sets;
    for (auto first = keys.begin(); first != keys.end();) {
        auto const last = std::find_if(first, keys.end(),
                                       [&](auto const& key) { return key.first != first->first; });
        bool const isSet = last - first >= static_cast<std::ptrdiff_t>(leastRows);
        if (isSet) sets.emplace_back();
        for (; first != last; ++first) (isSet ? sets.back() : others).push_back(first->second);
    }
    std::sort(sets.begin(), sets.end(), [](auto const& a, auto const& b) { return a[0] < b[0]; });
    return sets;
}

}  // namespace

StencilGroups GroupRows(StencilRowsView const& rows) {
    constexpr size_t kLeastRows =
        6;  // below, filling up a panel of 16 costs more than the block saves
    StencilGroupsBuilder builder(rows.numRows, rows.numControls, rows.numSets);
    std::vector<int> columnOf(rows.numControls, -1);
    std::vector<Index> controls;
    std::vector<float> weights;

    auto const addSingle = [&](Index row) {
        auto const begin = rows.offsets[row], end = begin + rows.sizes[row];
        controls.assign(rows.indices + begin, rows.indices + end);
        weights.clear();
        for (int set = 0; set < rows.numSets; ++set) {
            weights.insert(weights.end(), rows.weights[set] + begin, rows.weights[set] + end);
        }
        builder.AddSingle(row, controls, weights);
    };
    std::vector<Index> singles;
    for (auto& members : FindRowsWithSameControls(rows, kLeastRows, singles)) {
        Index const first = members[0];
        if (rows.sizes[first] > StencilGroups::kMaxColumns || rows.sizes[first] == 0) {
            singles.insert(singles.end(), members.begin(), members.end());
            continue;
        }
        controls.assign(rows.indices + rows.offsets[first],
                        rows.indices + rows.offsets[first] + rows.sizes[first]);
        std::sort(controls.begin(), controls.end());
        controls.erase(std::unique(controls.begin(), controls.end()), controls.end());
        for (size_t i = 0; i < controls.size(); ++i) columnOf[controls[i]] = static_cast<int>(i);
        // Two sets of controls may share a hash; what does not belong stays single.
        auto const belongs = [&](Index row) {
            Index const* const begin = rows.indices + rows.offsets[row];
            return std::all_of(begin, begin + rows.sizes[row],
                               [&](Index i) { return columnOf[i] >= 0; });
        };
        auto const rest = std::stable_partition(members.begin(), members.end(), belongs);
        singles.insert(singles.end(), rest, members.end());
        members.erase(rest, members.end());
        weights.assign(static_cast<size_t>(rows.numSets) * members.size() * controls.size(), 0.0f);
        for (int set = 0; set < rows.numSets; ++set) {
            for (size_t i = 0; i < members.size(); ++i) {
                float* const to = &weights[(set * members.size() + i) * controls.size()];
                Index const begin = rows.offsets[members[i]];
                for (Index k = begin; k < begin + rows.sizes[members[i]]; ++k) {
                    to[columnOf[rows.indices[k]]] += rows.weights[set][k];
                }
            }
        }
        builder.AddGroup(builder.AddBlock(static_cast<int>(members.size()),
                                          static_cast<int>(controls.size()), weights),
                         members, controls);
        for (Index control : controls) columnOf[control] = -1;
    }
    std::sort(singles.begin(), singles.end());  // so that equal weights follow each other
    for (Index row : singles) addSingle(row);
    return builder.Finish();
}

}  // namespace limn::far_ext
