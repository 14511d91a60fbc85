// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>
#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/rows/points.h"
#include "far_ext/types.h"

namespace limn::far_ext {

/// A triangle of a level; side k lies opposite corner k.
struct Triangle {
    std::array<Index, 3> vertices;
    std::array<double, 3> cotangents, squares;  ///< of corners; of sides' lengths
    double area;
};

/// \throws Error  Unsupported: a face that is no triangle.  BadMesh: one without area, by its
/// number
Triangle MeasureTriangle(Far::TopologyLevel const& level, Points points, Index face);

/// The share of a triangle's area that is nearest to each corner; in an obtuse one half at the wide
/// angle and a quarter at the others.
std::array<double, 3> SplitArea(Triangle const& triangle);

/// How a triangle's area and its shares change when corners move.
///
/// Source  the area's gradient at a corner is n x (opposite side) / 2 for the unit normal n
class TriangleDerivatives {
public:
    using Vector = Eigen::Vector3d;
    using Matrix = Eigen::Matrix3d;

    /// \pre  a triangle with an area
    TriangleDerivatives(Triangle const& triangle, Points points);

    /// d area / d corner k.
    Vector const& GetGradient(size_t k) const { return _gradients[k]; }

    /// d GetGradient(k) / d corner l.
    Matrix FindHessian(size_t k, size_t l) const;

    /// d SplitArea[k] / d corner l.
    Vector FindShareGradient(size_t k, size_t l) const;

private:
    Triangle const& _triangle;
    std::array<Vector, 3> _sides;  // from corner k + 1 to corner k + 2
    std::array<Vector, 3> _gradients;
    Vector _normal;
    size_t _widest;
};

}  // namespace limn::far_ext
