// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/SparseCore>

#include "far_ext/rows/sparse_rows.h"

namespace limn::far_ext {

/// Rows seen as a matrix of Eigen's: the same arrays, valid as long as the rows are.
using SparseRowsView = Eigen::Map<Eigen::SparseMatrix<double, Eigen::RowMajor, int> const>;

inline SparseRowsView AsMatrix(SparseRows const& rows, Index numColumns) {
    return {
        rows.GetNumRows(),   numColumns,          static_cast<Eigen::Index>(rows.weights.size()),
        rows.offsets.data(), rows.indices.data(), rows.weights.data()};
}

}  // namespace limn::far_ext
