// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Geometry>
#include <Eigen/SparseCore>

#include "far_ext/types.h"

namespace limn::bench {

/// A level of the cascade as others write it down: M + L assembled from the triangles' entries into
/// a sparse matrix, sweeps by products with it, all in double.
class EigenCascade {
public:
    using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

    /// \param triangles  3 vertices each
    EigenCascade(std::vector<Index> triangles, Points start)
        : _triangles(std::move(triangles)), _start(std::move(start)) {
        _entries.reserve(4 * _triangles.size() + static_cast<size_t>(_start.rows()));
    }

    /// \param metric     where the triangles lie
    /// \param diffusion  sigma^2 / 2
    void Assemble(Points const& metric, double diffusion) {
        _entries.clear();
        _masses = Eigen::VectorXd::Zero(metric.rows());
        for (size_t face = 0; face < _triangles.size(); face += 3) {
            Index const* const t = &_triangles[face];
            Eigen::Vector3d const p[3] = {metric.row(t[0]), metric.row(t[1]), metric.row(t[2])};
            double const doubleArea = (p[1] - p[0]).cross(p[2] - p[0]).norm();
            for (int i = 0; i < 3; ++i) {
                int const j = (i + 1) % 3, k = (i + 2) % 3;
                double const weight = 0.5 * diffusion * (p[j] - p[i]).dot(p[k] - p[i]) / doubleArea;
                _entries.emplace_back(t[j], t[k], -weight);
                _entries.emplace_back(t[k], t[j], -weight);
                _entries.emplace_back(t[j], t[j], weight);
                _entries.emplace_back(t[k], t[k], weight);
                _masses[t[i]] += doubleArea / 6;
            }
        }
        for (Index i = 0; i < metric.rows(); ++i) _entries.emplace_back(i, i, _masses[i]);
        _matrix.resize(metric.rows(), metric.rows());
        _matrix.setFromTriplets(_entries.begin(), _entries.end());
    }

    /// Damped Jacobi sweeps.
    void Sweep(Points& x, int count, double damping) {
        Eigen::VectorXd const scales = damping * _matrix.diagonal().cwiseInverse();
        Points const rightSide = _masses.asDiagonal() * _start;
        for (int sweep = 0; sweep < count; ++sweep) {
            _residual = rightSide;
            _residual.noalias() -= _matrix * x;
            x.noalias() += scales.asDiagonal() * _residual;
        }
    }

private:
    std::vector<Index> _triangles;
    Points _start, _residual;
    std::vector<Eigen::Triplet<double>> _entries;
    Eigen::VectorXd _masses;
    Eigen::SparseMatrix<double, Eigen::RowMajor> _matrix;
};

}  // namespace limn::bench
