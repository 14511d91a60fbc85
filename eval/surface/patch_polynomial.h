// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace limn::eval {

/// A polynomial patch in power form about its domain's centre: the form whose second derivatives
/// keep their digits in float.
///
/// Quad      16 coefficients [j][i] of x^i y^j, i, j <= 3, with x = s - 1/2, y = t - 1/2.
/// Triangle  15 coefficients of x^i y^j, i + j <= 4, ordered by j, then i, with x = s - 1/3,
///           y = t - 1/3.
inline constexpr int kQuadCoefficients = 16, kTriangleCoefficients = 15;
inline constexpr double kQuadCentre = 0.5, kTriangleCentre = 1.0 / 3.0;

/// 16 control points of a uniform bicubic B-spline (row t, column s) to power form.
/// Points lie `stride` doubles apart.
void BSplineToPower(double const* points, int stride, double* coefficients);

/// 12 control points of the quartic box spline (order of far_ext::kBoxSplineLattice) to power form.
void BoxSplineToPower(double const* points, int stride, double* coefficients);

/// Value and derivatives d/ds, d/dt, d2/dss, d2/dst, d2/dtt of one polynomial at (x, y).
std::array<double, 6> EvaluateQuadPolynomial(double const* coefficients, double x, double y);
std::array<double, 6> EvaluateTrianglePolynomial(double const* coefficients, double x, double y);

}  // namespace limn::eval
