// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "engine/io/atomic_file.h"
#include "far_ext/rows/sparse_matrix.h"

namespace limn::engine {

/// What a written matrix maps to what, for whoever opens the file.
struct MatrixNames {
    std::string rows, columns;  ///< e.g. "limit points of vertices", "vertices"
};

/// A sparse matrix as a text file of Matrix Market's coordinate form: numbered from 1, row by row
/// and in a row column by column, with 17 digits, and without what is below 1e-15.
///
/// \param file    not committed
/// \param matrix  no column twice in a row
/// \throws Error  Io
void WriteMatrixMarket(AtomicFile& file, far_ext::SparseRowsView const& matrix,
                       MatrixNames const& names);

}  // namespace limn::engine
