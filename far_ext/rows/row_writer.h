// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "far_ext/error.h"
#include "far_ext/rows/sparse_rows.h"

namespace limn::far_ext {

/// Rows of known sizes, filled in any order.
class RowWriter {
public:
    explicit RowWriter(Index numRows) { _rows.offsets.assign(size_t{1} + numRows, 0); }

    void SetSize(Index row, size_t size) { _rows.offsets[row + 1] = static_cast<int>(size); }

    /// \throws Error  TooLarge: more than 2^31 entries
    void Allocate() {
        size_t total = 0;
        for (size_t row = 1; row < _rows.offsets.size(); ++row) {
            total += _rows.offsets[row];
            if (total > static_cast<size_t>(std::numeric_limits<int>::max())) {
                throw Error(ErrorCode::TooLarge,
                            "a table of stencils passes 2^31 entries; refine fewer levels");
            }
            _rows.offsets[row] = static_cast<int>(total);
        }
        _rows.indices.resize(total);
        _rows.weights.resize(total);
    }

    void Start(Index row) { _at = _rows.offsets[row]; }
    void Add(Index column, double weight) {
        _rows.indices[_at] = column;
        _rows.weights[_at++] = weight;
    }

    /// Adds up entries of the same column in a row: a side that two faces share (valence 2, small
    /// closed meshes) comes twice.
    void MarkRepeated(Index row) { _repeated.push_back(row); }

    SparseRows Get() {
        if (!_repeated.empty()) Merge();
        return std::move(_rows);
    }

private:
    void Merge() {
        std::vector<char> isRepeated(_rows.offsets.size(), 0);
        for (Index row : _repeated) isRepeated[row] = 1;
        size_t to = 0, next = 0;
        for (int row = 0; row < _rows.GetNumRows(); ++row) {
            size_t const first = to, end = _rows.offsets[row + 1];
            for (size_t k = next; k < end; ++k) {
                size_t same = first;
                while (isRepeated[row] && same < to && _rows.indices[same] != _rows.indices[k])
                    ++same;
                if (isRepeated[row] && same < to) {
                    _rows.weights[same] += _rows.weights[k];
                    continue;
                }
                _rows.indices[to] = _rows.indices[k];
                _rows.weights[to++] = _rows.weights[k];
            }
            next = end;
            _rows.offsets[row + 1] = static_cast<int>(to);
        }
        _rows.indices.resize(to);
        _rows.weights.resize(to);
    }

    SparseRows _rows;
    std::vector<Index> _repeated;
    size_t _at = 0;
};

}  // namespace limn::far_ext
