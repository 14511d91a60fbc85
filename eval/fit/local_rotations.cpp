// SPDX-License-Identifier: Apache-2.0
#include "eval/fit/local_rotations.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "eval/parallel/rows.h"
#include "far_ext/rows/points.h"

namespace limn::eval {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Level = Far::TopologyLevel;

/// Of the box round points; 1 where they all lie in one place.
double FindLargestSide(std::span<double const> positions) {
    double side = 0.0;
    for (size_t axis = 0; axis < 3 && axis < positions.size(); ++axis) {
        double low = positions[axis], high = low;
        for (size_t i = axis; i < positions.size(); i += 3) {
            low = std::min(low, positions[i]);
            high = std::max(high, positions[i]);
        }
        side = std::max(side, high - low);
    }
    return side > 0.0 ? side : 1.0;
}

/// A mesh of size 1, so that products of its edges neither vanish nor overflow, with the area
/// vectors of its faces.
class Shape {
public:
    Shape(Level const& level, std::span<double const> positions)
        : _level(level), _points(positions), _scale(1.0 / FindLargestSide(positions)) {
        _areas.resize(static_cast<size_t>(level.GetNumFaces()));
        ForEachRow(level.GetNumFaces(), [&](Index face) {
            auto const corners = level.GetFaceVertices(face);
            Vector3d area = Vector3d::Zero();
            for (int i = 1; i + 1 < corners.size(); ++i) {
                area +=
                    FindEdge(corners[0], corners[i]).cross(FindEdge(corners[0], corners[i + 1]));
            }
            _areas[face] = area;
        });
    }

    Vector3d FindEdge(Index from, Index to) const { return _scale * (_points[to] - _points[from]); }

    Vector3d FindNormal(Index vertex) const {
        Vector3d sum = Vector3d::Zero();
        for (Index face : _level.GetVertexFaces(vertex)) sum += _areas[face];
        return sum.stableNormalized();
    }

private:
    Level const& _level;
    far_ext::Points _points;
    double _scale;
    std::vector<Vector3d> _areas;
};

/// H of a vertex.
Matrix3d Correlate(Level const& level, Index vertex, Shape const& from, Shape const& to) {
    Matrix3d H = Matrix3d::Zero();
    double lengths = 0.0;
    auto const edges = level.GetVertexEdges(vertex);
    for (Index edge : edges) {
        auto const ends = level.GetEdgeVertices(edge);
        Index const other = ends[0] == vertex ? ends[1] : ends[0];
        Vector3d const a = from.FindEdge(vertex, other), b = to.FindEdge(vertex, other);
        H += a * b.transpose();
        lengths += a.norm() * b.norm();
    }
    if (lengths > 0.0) {
        H += lengths / edges.size() * from.FindNormal(vertex) * to.FindNormal(vertex).transpose();
    }
    return H;
}

/// The rotation R for which the trace of R H is largest.
Matrix3d FindRotation(Matrix3d const& H) {
    if (!H.allFinite() || H.isZero(0.0)) return Matrix3d::Identity();
    Eigen::JacobiSVD<Matrix3d> const svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Matrix3d V = svd.matrixV();
    if ((V * svd.matrixU().transpose()).determinant() < 0.0) V.col(2) *= -1.0;
    return V * svd.matrixU().transpose();
}

double FindTurn(Matrix3d const& R) {
    Vector3d const axis(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
    return std::atan2(axis.norm(), R.trace() - 1.0) * 180.0 / std::numbers::pi;
}

}  // namespace

LocalRotations::LocalRotations(Level const& level, std::span<double const> from,
                               std::span<double const> to)
    : _rotations(static_cast<size_t>(level.GetNumVertices())) {
    Shape const fromShape(level, from), toShape(level, to);
    ForEachRow(level.GetNumVertices(), [&](Index vertex) {
        _rotations[vertex] = FindRotation(Correlate(level, vertex, fromShape, toShape));
    });
}

void LocalRotations::Apply(std::span<double> vectors) const {
    far_ext::MutablePoints const points(vectors);
    ForEachRow(static_cast<Index>(_rotations.size()), [&](Index vertex) {
        Vector3d const turned = _rotations[vertex] * points[vertex];
        points[vertex] = turned;
    });
}

double LocalRotations::FindLargestTurn() const {
    double largest = 0.0;
    for (Matrix3d const& R : _rotations) largest = std::max(largest, FindTurn(R));
    return largest;
}

}  // namespace limn::eval
