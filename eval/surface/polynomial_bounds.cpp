// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/polynomial_bounds.h"

#include <cmath>

namespace limn::eval {

PolynomialBounds BoundPolynomial(bool isTriangle, double const* coefficients) {
    double const farthest = isTriangle ? 2.0 / 3.0 : 0.5;  // |x|, |y| over the domain
    double power[8] = {1, farthest};
    for (int i = 2; i < 8; ++i) power[i] = power[i - 1] * farthest;
    PolynomialBounds bounds{};
    double* const b = bounds.second;
    int index = 0;
    for (int j = 0; j < (isTriangle ? 5 : 4); ++j) {
        for (int i = 0; i < (isTriangle ? 5 - j : 4); ++i, ++index) {
            double const c = std::abs(coefficients[index]);
            if (i + j > 0) bounds.reach += c * power[i + j];
            if (i > 1) b[0] += i * (i - 1) * c * power[i + j - 2];
            if (i > 0 && j > 0) b[1] += i * j * c * power[i + j - 2];
            if (j > 1) b[2] += j * (j - 1) * c * power[i + j - 2];
        }
    }
    return bounds;
}

}  // namespace limn::eval
