// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limn::eval {

/// Bounds of a polynomial patch (patch_polynomial.h) over its domain.
struct PolynomialBounds {
    double second[3];  ///< of |d2/dss|, |d2/dst|, |d2/dtt|
    double reach;      ///< of how far it strays from its value at the domain's centre

    /// Bound of how far it strays from its linear part within `half` of a place.
    double GetStray(double half) const {
        return 0.5 * half * half * (second[0] + 2 * second[1] + second[2]);
    }
};

/// From the magnitudes of the coefficients, term by term.
PolynomialBounds BoundPolynomial(bool isTriangle, double const* coefficients);

}  // namespace limn::eval
