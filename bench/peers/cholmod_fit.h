// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <cholmod.h>

#include "far_ext/limit/limit_matrix.h"

namespace limn::bench {

/// A P = M by CHOLMOD: D A is symmetric and positive definite on closed meshes; analysis,
/// factorisation (supernodal, its own choice of ordering) and three right sides. GPL, so in benches
/// only.
inline std::vector<double> SolveByCholmod(far_ext::LimitMatrix const& A,
                                          std::vector<double> const& M) {
    cholmod_common common;
    cholmod_start(&common);
    size_t const size = static_cast<size_t>(A.GetNumStencils());
    auto const& offsets = A.GetOffsets();
    auto const& columns = A.GetControlIndices();
    auto const& weights = A.GetWeights();
    cholmod_triplet* const entries =
        cholmod_allocate_triplet(size, size, columns.size(), 1, CHOLMOD_REAL, &common);
    int count = 0;
    for (int row = 0; row < A.GetNumStencils(); ++row) {
        for (size_t k = static_cast<size_t>(offsets[static_cast<size_t>(row)]);
             k < static_cast<size_t>(offsets[static_cast<size_t>(row) + 1]); ++k) {
            if (columns[k] < row) continue;  // the upper triangle
            static_cast<int*>(entries->i)[count] = row;
            static_cast<int*>(entries->j)[count] = columns[k];
            static_cast<double*>(entries->x)[count++] =
                A.GetScales()[static_cast<size_t>(row)] * weights[k];
        }
    }
    entries->nnz = static_cast<size_t>(count);
    cholmod_sparse* const matrix = cholmod_triplet_to_sparse(entries, 0, &common);
    cholmod_dense* const right = cholmod_allocate_dense(size, 3, size, CHOLMOD_REAL, &common);
    for (size_t i = 0; i < size; ++i) {
        for (size_t c = 0; c < 3; ++c)
            static_cast<double*>(right->x)[c * size + i] = A.GetScales()[i] * M[3 * i + c];
    }
    cholmod_factor* factor = cholmod_analyze(matrix, &common);
    cholmod_factorize(matrix, factor, &common);
    cholmod_dense* solution = cholmod_solve(CHOLMOD_A, factor, right, &common);
    std::vector<double> P(3 * size);
    for (size_t i = 0; i < size; ++i) {
        for (size_t c = 0; c < 3; ++c)
            P[3 * i + c] = static_cast<double*>(solution->x)[c * size + i];
    }
    cholmod_free_dense(&solution, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_dense* toFree = right;
    cholmod_free_dense(&toFree, &common);
    cholmod_sparse* matrixToFree = matrix;
    cholmod_free_sparse(&matrixToFree, &common);
    cholmod_triplet* entriesToFree = entries;
    cholmod_free_triplet(&entriesToFree, &common);
    cholmod_finish(&common);
    return P;
}

}  // namespace limn::bench
