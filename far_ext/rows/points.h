// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <span>
#include <string_view>
#include <type_traits>

#include <Eigen/Core>

#include "far_ext/types.h"

namespace limn::far_ext {

/// The points of a mesh, 3 doubles per vertex one after another, as vectors by the vertex's number:
///
///     Points const points(positions);
///     double const length = (points[ends[1]] - points[ends[0]]).norm();
///
/// A view, made and passed for nothing: it copies no number, and what it looks at must outlive it.
/// A vector it hands out is a view, too; what is to keep its value becomes an Eigen::Vector3d.
///
/// Bits  Eigen adds the three products of a dot, norm or squared norm from x to z, as a loop does.
template <class Real>
class PointSpan {
public:
    using Vector =
        std::conditional_t<std::is_const_v<Real>, Eigen::Vector3d const, Eigen::Vector3d>;

    template <class Values>
        requires std::constructible_from<std::span<Real>, Values&>
    PointSpan(Values&& values) : _values(values) {}

    Eigen::Map<Vector> operator[](size_t vertex) const {
        return Eigen::Map<Vector>(_values.data() + 3 * vertex);
    }
    size_t GetCount() const { return _values.size() / 3; }

private:
    std::span<Real> _values;
};

using Points = PointSpan<double const>;
using MutablePoints = PointSpan<double>;

/// Refuses an array that ends before what it is to hold.
///
/// \param name    the array's name in the message
/// \param owners  what has values, with its number: "vertices"
/// \throws Error  BadOption: fewer than `length` values for each of the `count` owners
void CheckLength(std::string_view name, std::span<double const> values, Index count,
                 std::string_view owners, int length);

/// The same for points.
inline void CheckPoints(std::span<double const> positions, Index numVertices) {
    CheckLength("positions", positions, numVertices, "vertices", 3);
}

}  // namespace limn::far_ext
