// SPDX-License-Identifier: Apache-2.0
#include "eval/cascade/feature_filter.h"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "eval/parallel/rows.h"

namespace limn::eval {

namespace {

using far_ext::CascadeLevel;
using Corners = std::array<Index, 3>;

Eigen::Vector3d PointOf(CascadeRows<double> const& rows, Index row) {
    return rows[row].head<3>().matrix();
}

/// Calls visit(corners, k, next) for the triangles round a surface row, which is corners[0], with
/// the entries of its ring that the other two are.
template <class Visit>
void VisitTriangles(CascadeLevel const& level, Index row, Visit const& visit) {
    int const begin = level.offsets[row], end = level.offsets[row + 1];
    bool const isClosed = row < level.numClosed;
    for (int k = begin; k < end - (isClosed ? 0 : 1); ++k) {
        int const next = k + 1 < end ? k + 1 : begin;
        visit(Corners{row, level.neighbours[k], level.neighbours[next]}, k, next);
    }
}

/// The corners from the lowest row on, so that all three corners see the same bits. \return where
/// the first of them is now
int StartAtLowest(Corners& corners) {
    int lowest = 0;
    for (int k : {1, 2})
        if (corners[k] < corners[lowest]) lowest = k;
    std::rotate(corners.begin(), corners.begin() + lowest, corners.end());
    return (3 - lowest) % 3;
}

/// One triangle in coordinates of its own plane.
class FeatureTriangle {
public:
    FeatureTriangle(CascadeRows<double> const& metric, Corners const& corners) {
        Eigen::Vector3d const origin = PointOf(metric, corners[0]);
        Eigen::Vector3d const a = PointOf(metric, corners[1]) - origin,
                              b = PointOf(metric, corners[2]) - origin;
        // The bound that the plain filter has on slivers.
        constexpr double kLeastSine = 1e-7;
        double const cross = a.cross(b).norm(),
                     least = kLeastSine * (a.squaredNorm() + b.squaredNorm() - a.dot(b));
        _doubleArea = std::max(cross, least);
        double const length = a.norm();
        if (!(cross > 0.0 && length > 0.0)) return;
        _along = a / length;
        _across = (b - _along.dot(b) * _along).normalized();
        std::array<Eigen::Vector2d, 3> const points{Eigen::Vector2d(0.0, 0.0), ToPlane(a),
                                                    ToPlane(b)};
        for (size_t k = 0; k < 3; ++k) {
            Eigen::Vector2d const edge = points[(k + 2) % 3] - points[(k + 1) % 3];
            _turned[k] = {-edge.y(), edge.x()};
        }
    }

    /// L of corners i and j without a_T.
    double GetStiffness(Eigen::Matrix2d const& A, int i, int j) const {
        return _doubleArea > 0.0 ? _turned[i].dot(A * _turned[j]) / (2.0 * _doubleArea) : 0.0;
    }

    /// How much of a gradient flows, by direction.
    Eigen::Matrix2d FindTensor(std::array<Eigen::Vector3d, 3> const& normals, double lambda) const {
        Eigen::Matrix2d S = Eigen::Matrix2d::Zero();
        for (size_t k = 0; k < 3 && _doubleArea > 0.0; ++k)
            S += ToPlane(normals[k]) * (_turned[k] / _doubleArea).transpose();  // grad phi
        S = (0.5 / lambda * (S + S.transpose())).eval();
        Eigen::Matrix2d const B = Eigen::Matrix2d::Identity() + S * S;
        return B.allFinite() ? Eigen::Matrix2d(B.inverse()) : Eigen::Matrix2d::Zero();
    }

private:
    Eigen::Vector2d ToPlane(Eigen::Vector3d const& v) const {
        return {_along.dot(v), _across.dot(v)};
    }

    Eigen::Vector3d _along = Eigen::Vector3d::Zero(), _across = Eigen::Vector3d::Zero();
    std::array<Eigen::Vector2d, 3> _turned{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                           Eigen::Vector2d::Zero()};
    double _doubleArea = 0.0;
};

/// The mean of sigma^2 / 2 of a linear sigma.
double FindDiffusion(CascadeRows<double> const& metric, Corners const& corners, double width) {
    if (width >= 0.0) return 0.5 * width * width;
    double const h0 = metric[corners[0]][3], h1 = metric[corners[1]][3], h2 = metric[corners[2]][3];
    return (h0 * h0 + h1 * h1 + h2 * h2 + h0 * h1 + h1 * h2 + h2 * h0) / 12.0;
}

}  // namespace

std::vector<Eigen::Vector3d> FindRowNormals(CascadeLevel const& level,
                                            CascadeRows<double> const& surface) {
    std::vector<Eigen::Vector3d> normals(surface.size(), Eigen::Vector3d::Zero());
    for (Index row = 0; row < level.numSurface; ++row) {
        VisitTriangles(level, row, [&](Corners const& corners, int, int) {
            bool const isFirst = row <= corners[1] && row <= corners[2];
            if (!isFirst) return;  // another corner adds it
            Eigen::Vector3d const origin = PointOf(surface, corners[0]);
            Eigen::Vector3d const area = (PointOf(surface, corners[1]) - origin)
                                             .cross(PointOf(surface, corners[2]) - origin);
            for (Index corner : corners) normals[corner] += area;
        });
    }
    for (Eigen::Vector3d& normal : normals) {
        double const length = normal.norm();
        if (length > 0.0) normal /= length;
    }
    return normals;
}

void KeepFeatures(CascadeLevel const& level, CascadeRows<double> const& metric,
                  std::vector<Eigen::Vector3d> const& normals, double width, double lambda,
                  CascadeOperator<double>& op) {
    ForEachRow(level.numSurface, [&](Index row) {
        int const begin = level.offsets[row], end = level.offsets[row + 1];
        std::fill(op.edges.begin() + begin, op.edges.begin() + end, 0.0);
        VisitTriangles(level, row, [&](Corners corners, int k, int next) {
            int const own = StartAtLowest(corners);
            FeatureTriangle const triangle(metric, corners);
            Eigen::Matrix2d const A = triangle.FindTensor(
                {normals[corners[0]], normals[corners[1]], normals[corners[2]]}, lambda);
            double const a = FindDiffusion(metric, corners, width);
            op.edges[k] -= a * triangle.GetStiffness(A, own, (own + 1) % 3);
            op.edges[next] -= a * triangle.GetStiffness(A, own, (own + 2) % 3);
        });
        if (op.diagonals[row] == 0.0) return;  // nothing moves it
        op.diagonals[row] = op.masses[row];
        for (int k = begin; k < end; ++k) op.diagonals[row] += op.edges[k];
    });
}

}  // namespace limn::eval
