// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "far_ext/rows/large_array.h"
#include "far_ext/types.h"

namespace limn::far_ext {

/// One row of weights over control points: what OpenSubdiv's PrimvarRefiner blends when its rules
/// are to be learnt as weights rather than applied to values.
class WeightRow {
public:
    void Clear() { _entries.clear(); }

    void AddWithWeight(WeightRow const& other, double weight) {
        if (weight == 0.0) return;
        for (auto const& [index, value] : other._entries) Add(index, weight * value);
    }

    void Add(Index index, double weight) {
        for (auto& [present, value] : _entries) {
            if (present == index) {
                value += weight;
                return;
            }
        }
        _entries.emplace_back(index, weight);
    }

    std::vector<std::pair<Index, double>> const& GetEntries() const { return _entries; }

    static std::vector<WeightRow> Identity(Index count) {
        std::vector<WeightRow> rows(count);
        for (Index i = 0; i < count; ++i) rows[i].Add(i, 1.0);
        return rows;
    }

private:
    std::vector<std::pair<Index, double>> _entries;
};

/// Rows of weights in compressed form: point i = sum over k in [offsets[i], offsets[i+1]) of
/// weights[k] * points[indices[k]].
struct SparseRows {
    std::vector<int> offsets{0};
    LargeArray<Index> indices;
    LargeArray<double> weights;

    int GetNumRows() const { return static_cast<int>(offsets.size()) - 1; }

    void AddRow(WeightRow const& row) {
        for (auto const& [index, weight] : row.GetEntries()) {
            indices.push_back(index);
            weights.push_back(weight);
        }
        offsets.push_back(static_cast<int>(indices.size()));
    }

    /// dst[i] = row i applied to src, for rows of `length` doubles that lie one after another.
    void Apply(double const* src, double* dst, int length) const {
        switch (length) {  // what most callers ask for, without inner loops
            case 2:
                return ApplyTo<2>(src, dst, 2);
            case 3:
                return ApplyTo<3>(src, dst, 3);
            default:
                return ApplyTo<0>(src, dst, length);
        }
    }

    /// The same for one number per point.
    std::vector<double> Apply(std::vector<double> const& src) const {
        std::vector<double> dst(GetNumRows());
        ApplyTo<1>(src.data(), dst.data(), 1);
        return dst;
    }

private:
    template <int FixedLength>
    void ApplyTo(double const* src, double* dst, int anyLength) const {
        int const length = FixedLength ? FixedLength : anyLength;
        for (int row = 0; row < GetNumRows(); ++row, dst += length) {
            for (int c = 0; c < length; ++c) dst[c] = 0.0;
            for (int k = offsets[row]; k < offsets[row + 1]; ++k) {
                double const* const point = src + static_cast<size_t>(indices[k]) * length;
                for (int c = 0; c < length; ++c) dst[c] += weights[k] * point[c];
            }
        }
    }
};

}  // namespace limn::far_ext
