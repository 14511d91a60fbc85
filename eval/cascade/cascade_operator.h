// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "far_ext/cascade/cascade_level.h"
#include "far_ext/rows/large_array.h"

namespace limn::eval {

struct CascadeRings;

/// Position and filter width of a row: x, y, z, sigma.
template <class Scalar>
using CascadeRow = Eigen::Array<Scalar, 4, 1>;
template <class Scalar>
using CascadeRows = far_ext::LargeArray<CascadeRow<Scalar>>;

/// How well the triangles of a metric are shaped; of quads, those of both diagonals.
struct MetricQuality {
    double minAngleRadians = 0.0;
    double areaRatio = 0.0;  ///< smallest area to the mean one
    double area = 0.0;       ///< of all that is not fixed
};

/// The operator M + L of one level for one metric.
///
///     M  lumped mass, a third of the areas at a row
///     L  stiffness: L_ij = -a_T cot / 2 for both triangles of an edge, a_T the mean of sigma^2 / 2
///        on the triangle
///
/// Quads   stand for the two pairs of triangles that their diagonals make, each with half of its
///         weight: a rule that does not depend on the order of corners. Only the metric knows these
///         triangles.
/// Creases A row on a crease sees the crease alone: M a half of its two edges, L_ij = -a / length.
/// Slivers Angles below 1e-7 (in float 1e-3) are taken for as large, so that weights stay finite.
/// Source  [Diewald02] Sec. 7 and 8
template <class Scalar>
struct CascadeOperator {
    far_ext::LargeArray<Scalar> edges;   ///< -L_ij, per entry of CascadeLevel::neighbours
    far_ext::LargeArray<Scalar> masses;  ///< M_ii, per unknown
    far_ext::LargeArray<Scalar>
        diagonals;  ///< M_ii + L_ii, per unknown; 0 where nothing moves a row: X = X0 there
    int order = 2;  ///< 2: solvers take M + L, 4: M + L M^-1 L, with L X = 0 on rows that stay
};

/// The level's rings as kernels take them.
CascadeRings GetRings(far_ext::CascadeLevel const& level);

/// Builds the operator from a metric, on the calling arena's threads.
///
/// \param width   sigma of all rows; negative: that of the metric's rows
MetricQuality BuildOperator(far_ext::CascadeLevel const& level, CascadeRows<float> const& metric,
                            float width, CascadeOperator<float>& op);
MetricQuality BuildOperator(far_ext::CascadeLevel const& level, CascadeRows<double> const& metric,
                            double width, CascadeOperator<double>& op);

/// M (X0 - X) - L X of one row.
template <class Scalar>
inline CascadeRow<Scalar> FindResidual(far_ext::CascadeLevel const& level,
                                       CascadeOperator<Scalar> const& op,
                                       CascadeRow<Scalar> const* x, CascadeRow<Scalar> const* x0,
                                       Index row) {
    CascadeRow<Scalar> const own = x[row];
    CascadeRow<Scalar> sum = op.masses[row] * (x0[row] - own);
    CascadeRow<Scalar> other =
        CascadeRow<Scalar>::Zero();  // two sums at once: an addition takes several cycles
    int k = level.offsets[row];
    int const end = level.offsets[row + 1];
    for (; k + 1 < end; k += 2) {
        sum += op.edges[k] * (x[level.neighbours[k]] - own);
        other += op.edges[k + 1] * (x[level.neighbours[k + 1]] - own);
    }
    if (k < end) sum += op.edges[k] * (x[level.neighbours[k]] - own);
    return sum + other;
}

}  // namespace limn::eval
