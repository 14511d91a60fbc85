// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "far_ext/types.h"

namespace limn::far_ext {

/// What a row's weights make: the value, or a derivative of the limit at the row's place.
enum class WeightSet { Value, Du, Dv, Duu, Duv, Dvv };
inline constexpr int kMaxWeightSets = 6;

/// Stencil rows as plain arrays, the form in which Far keeps its tables: row i is the sum over k in
/// [offsets[i], offsets[i] + sizes[i]) of weights[set][k] * control[indices[k]].
///
/// A view: the arrays stay with their owner. Usable from C++17, like all of this header.
struct StencilRowsView {
    int const* sizes = nullptr;
    Index const* offsets = nullptr;
    Index const* indices = nullptr;
    std::array<float const*, kMaxWeightSets> weights{};  ///< the first numSets are not null
    int numSets = 1;                                     ///< 1 (values), 3 or 6
    Index numRows = 0;
    Index numControls = 0;
};

/// Owner of such rows, with the accessors of Far::LimitStencilTable: whatever takes Far's tables by
/// template (Osd::CpuEvaluator among them) takes this one.
class StencilRows {
public:
    StencilRows(Index numControls, int numSets) : _numControls(numControls), _numSets(numSets) {}

    Index GetNumStencils() const { return static_cast<Index>(_sizes.size()); }
    Index GetNumControlVertices() const { return _numControls; }
    int GetNumSets() const { return _numSets; }
    std::vector<int> const& GetSizes() const { return _sizes; }
    std::vector<Index> const& GetOffsets() const { return _offsets; }
    std::vector<Index> const& GetControlIndices() const { return _indices; }
    std::vector<float> const& GetWeights() const { return Get(WeightSet::Value); }
    std::vector<float> const& GetDuWeights() const { return Get(WeightSet::Du); }
    std::vector<float> const& GetDvWeights() const { return Get(WeightSet::Dv); }
    std::vector<float> const& GetDuuWeights() const { return Get(WeightSet::Duu); }
    std::vector<float> const& GetDuvWeights() const { return Get(WeightSet::Duv); }
    std::vector<float> const& GetDvvWeights() const { return Get(WeightSet::Dvv); }

    /// Appends an entry to the row that EndRow will close; `weights` holds one per set.
    void AddEntry(Index control, float const* weights) {
        _indices.push_back(control);
        for (int set = 0; set < _numSets; ++set) _weights[set].push_back(weights[set]);
    }
    /// \throws Error  TooLarge: more than 2^31 entries
    void EndRow();

    StencilRowsView GetView() const {
        StencilRowsView view{_sizes.data(), _offsets.data(),  _indices.data(), {},
                             _numSets,      GetNumStencils(), _numControls};
        for (int set = 0; set < _numSets; ++set) view.weights[set] = _weights[set].data();
        return view;
    }

private:
    std::vector<float> const& Get(WeightSet set) const {
        return _weights[static_cast<std::size_t>(set)];
    }

    Index _numControls;
    int _numSets;
    std::vector<int> _sizes;
    std::vector<Index> _offsets, _indices;
    std::array<std::vector<float>, kMaxWeightSets> _weights;
};

/// The rows of a table with Far's accessors that holds values only.
template <class Table>
StencilRowsView ViewStencils(Table const& table) {
    StencilRowsView view;
    view.sizes = table.GetSizes().data();
    // Far makes offsets on request only; Validate refuses rows without them.
    view.offsets = table.GetOffsets().empty() ? nullptr : table.GetOffsets().data();
    view.indices = table.GetControlIndices().data();
    view.weights[0] = table.GetWeights().data();
    view.numRows = table.GetNumStencils();
    view.numControls = table.GetNumControlVertices();
    return view;
}

/// The rows of a table with Far's accessors for limits, with as many derivatives as it holds.
template <class Table>
StencilRowsView ViewLimitStencils(Table const& table) {
    StencilRowsView view = ViewStencils(table);
    std::vector<float> const* const sets[] = {&table.GetDuWeights(), &table.GetDvWeights(),
                                              &table.GetDuuWeights(), &table.GetDuvWeights(),
                                              &table.GetDvvWeights()};
    for (std::vector<float> const* set : sets) {
        if (set->empty() || set->size() != table.GetWeights().size()) break;
        view.weights[static_cast<std::size_t>(view.numSets++)] = set->data();
    }
    return view;
}

/// Refuses rows that would be read out of bounds or would make values that are not numbers.
///
/// \throws Error  BadMesh: no offsets, a negative size or offset, an index outside [0,
///                numControls), a weight that is not finite
void Validate(StencilRowsView const& rows);

}  // namespace limn::far_ext
