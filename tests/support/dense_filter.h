// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Dense>

#include "engine/scene/scene.h"

namespace limn::test {

/// The filter's matrices of a mesh of triangles, by triangles and dense: M a third of the areas,
/// and L_ij = e_i.e_j / (4 |T|), without a width.
struct DenseFilter {
    Eigen::MatrixXd M, L;

    DenseFilter(std::vector<Index> const& faces, std::vector<double> const& positions) {
        Eigen::Index const count = static_cast<Eigen::Index>(positions.size() / 3);
        M = L = Eigen::MatrixXd::Zero(count, count);
        for (size_t face = 0; face < faces.size(); face += 3) {
            Eigen::Vector3d opposite[3];
            for (size_t k = 0; k < 3; ++k) {
                opposite[k] = Point(positions, faces[face + (k + 2) % 3]) -
                              Point(positions, faces[face + (k + 1) % 3]);
            }
            double const area = opposite[0].cross(opposite[1]).norm() / 2;
            for (size_t i = 0; i < 3; ++i) {
                M(faces[face + i], faces[face + i]) += area / 3;
                for (size_t j = 0; j < 3; ++j)
                    L(faces[face + i], faces[face + j]) +=
                        opposite[i].dot(opposite[j]) / (4 * area);
            }
        }
    }

    static Eigen::Vector3d Point(std::vector<double> const& positions, Index vertex) {
        return Eigen::Map<Eigen::Vector3d const>(&positions[3 * static_cast<size_t>(vertex)]);
    }
};

/// Solves A X = B where all rows are unknown, or X = X0 where they are not.
inline Eigen::MatrixXd SolveWithFixed(Eigen::MatrixXd A, Eigen::MatrixXd B,
                                      Eigen::MatrixXd const& X0, std::vector<char> const& isFixed) {
    for (Eigen::Index row = 0; row < A.rows(); ++row) {
        if (!isFixed[static_cast<size_t>(row)]) continue;
        A.row(row).setZero();
        A(row, row) = 1.0;
        B.row(row) = X0.row(row);
    }
    return A.partialPivLu().solve(B);
}

}  // namespace limn::test
