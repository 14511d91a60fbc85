// SPDX-License-Identifier: Apache-2.0
#include "far_ext/differential/triangle.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::far_ext {

namespace {

size_t FindWidest(Triangle const& triangle) {
    auto const& cot = triangle.cotangents;
    return std::min_element(cot.begin(), cot.end()) - cot.begin();
}

/// How corner l moves the start (-1) or end (+1) of side k.
double GetSign(size_t k, size_t l) {
    return l == (k + 2) % 3 ? 1.0 : l == (k + 1) % 3 ? -1.0 : 0.0;
}

Eigen::Matrix3d MakeCross(Eigen::Vector3d const& a) {
    Eigen::Matrix3d cross;
    cross << 0.0, -a[2], a[1], a[2], 0.0, -a[0], -a[1], a[0], 0.0;
    return cross;
}

}  // namespace

Triangle MeasureTriangle(Far::TopologyLevel const& level, Points points, Index face) {
    auto const vertices = level.GetFaceVertices(face);
    if (vertices.size() != 3) {
        throw Error(ErrorCode::Unsupported,
                    fmt::format("face {} has {} corners; this Laplacian needs triangles, "
                                "`laplacian` combinatorial takes all",
                                face, vertices.size()));
    }
    Triangle triangle{{vertices[0], vertices[1], vertices[2]}, {}, {}, 0.0};
    std::array<double, 3> dots;
    for (size_t k = 0; k < 3; ++k) {
        auto const corner = points[triangle.vertices[k]];
        Eigen::Vector3d const a = points[triangle.vertices[(k + 1) % 3]] - corner,
                              b = points[triangle.vertices[(k + 2) % 3]] - corner;
        dots[k] = a.dot(b);
        double const square = a.squaredNorm();
        triangle.squares[(k + 2) % 3] = square;
        triangle.area =
            0.5 * std::sqrt(std::max(0.0, square * b.squaredNorm() - dots[k] * dots[k]));
    }
    double const longest =
        std::max({triangle.squares[0], triangle.squares[1], triangle.squares[2]});
    if (!(triangle.area > 1e-12 * longest)) {  // below, cotangents are rounding errors
        throw Error(ErrorCode::BadMesh, fmt::format("face {} (vertices {}, {}, {}) has no area, so "
                                                    "that its angles are not defined; move a "
                                                    "vertex or use the combinatorial Laplacian",
                                                    face, vertices[0], vertices[1], vertices[2]));
    }
    for (size_t k = 0; k < 3; ++k) triangle.cotangents[k] = dots[k] / (2.0 * triangle.area);
    return triangle;
}

std::array<double, 3> SplitArea(Triangle const& triangle) {
    std::array<double, 3> shares;
    auto const& cot = triangle.cotangents;
    size_t const widest = FindWidest(triangle);
    for (size_t k = 0; k < 3; ++k) {
        size_t const p = (k + 1) % 3, q = (k + 2) % 3;
        shares[k] = cot[widest] < 0.0
                        ? triangle.area * (k == widest ? 0.5 : 0.25)
                        : (triangle.squares[p] * cot[p] + triangle.squares[q] * cot[q]) / 8.0;
    }
    return shares;
}

TriangleDerivatives::TriangleDerivatives(Triangle const& triangle, Points points)
    : _triangle(triangle), _widest(FindWidest(triangle)) {
    for (size_t k = 0; k < 3; ++k)
        _sides[k] = points[triangle.vertices[(k + 2) % 3]] - points[triangle.vertices[(k + 1) % 3]];
    _normal = _sides[0].cross(_sides[1]).normalized();
    for (size_t k = 0; k < 3; ++k) _gradients[k] = 0.5 * _normal.cross(_sides[k]);
}

TriangleDerivatives::Matrix TriangleDerivatives::FindHessian(size_t k, size_t l) const {
    // The normal turns by (1 - n n^T) (side l x move) / (2 area), side k by its sign times the
    // move.
    Matrix const turn = (Matrix::Identity() - _normal * _normal.transpose()) *
                        MakeCross(_sides[l]) / (2.0 * _triangle.area);
    return 0.5 * (GetSign(k, l) * MakeCross(_normal) - MakeCross(_sides[k]) * turn);
}

TriangleDerivatives::Vector TriangleDerivatives::FindShareGradient(size_t k, size_t l) const {
    if (_triangle.cotangents[_widest] < 0.0) return (k == _widest ? 0.5 : 0.25) * _gradients[l];
    // Squared side times cotangent, which is -(the two other sides' product) / (2 area).
    auto const differentiate = [&](size_t p) -> Vector {
        size_t const a = (p + 1) % 3, b = (p + 2) % 3;
        double const square = _triangle.squares[p], twice = 2.0 * _triangle.area,
                     cotangent = _triangle.cotangents[p];
        Vector const ofSquare = 2.0 * GetSign(p, l) * _sides[p],
                     ofProduct = -GetSign(a, l) * _sides[b] - GetSign(b, l) * _sides[a],
                     ofCotangent = (ofProduct - cotangent * 2.0 * _gradients[l]) / twice;
        return cotangent * ofSquare + square * ofCotangent;
    };
    return (differentiate((k + 1) % 3) + differentiate((k + 2) % 3)) / 8.0;
}

}  // namespace limn::far_ext
