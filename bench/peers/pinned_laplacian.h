// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/SparseCore>

#include "eval/differential/multigrid_levels.h"

namespace limn::bench {

/// The combinatorial Laplacian of a closed mesh as others take it: a positive definite matrix,
/// without the first row, and three right-hand sides.
struct PinnedLaplacian {
    Eigen::SparseMatrix<double> matrix;
    Eigen::MatrixX3d rightSide;

    /// \param rightSideOfVertices  3 per vertex, in the range of the whole matrix
    PinnedLaplacian(eval::MultigridLevel const& level,
                    std::vector<double> const& rightSideOfVertices)
        : matrix(level.numUnknowns - 1, level.numUnknowns - 1),
          rightSide(level.numUnknowns - 1, 3) {
        std::vector<Eigen::Triplet<double>> entries;
        entries.reserve(level.neighbours.size() + level.vertices.size());
        for (Index row = 1; row < level.numUnknowns; ++row) {
            entries.emplace_back(row - 1, row - 1, level.offsets[row + 1] - level.offsets[row]);
            for (int k = level.offsets[row]; k < level.offsets[row + 1]; ++k) {
                if (level.neighbours[k] > 0)
                    entries.emplace_back(row - 1, level.neighbours[k] - 1, -1.0);
            }
            for (Index c = 0; c < 3; ++c)
                rightSide(row - 1, c) =
                    rightSideOfVertices[3 * static_cast<size_t>(level.vertices[row]) +
                                        static_cast<size_t>(c)];
        }
        matrix.setFromTriplets(entries.begin(), entries.end());
    }

    double FindResidual(Eigen::MatrixX3d const& x) const {
        return (matrix * x - rightSide).norm() / rightSide.norm();
    }
};

}  // namespace limn::bench
