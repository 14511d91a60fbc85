// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <complex>
#include <numbers>

namespace limn::eval {

// Angles and unit complex numbers by sums, products and roots only: the same bits on every CPU,
// which libm's are not.

/// The angle of (x, y), from -pi to pi; 0 of (0, 0).
inline double FindAngle(double x, double y) {
    double const length = std::sqrt(x * x + y * y);
    if (!(length > 0.0)) return 0.0;
    // Half the angle and half again until its tangent is below 0.1, where the series is short.
    std::complex<double> z(x / length, y / length);
    if (z.real() < -0.5) z = {-z.real(), -z.imag()};
    double factor = 1.0;
    while (std::abs(z.imag()) > 0.1 * z.real()) {
        double const real = std::sqrt(0.5 * (1.0 + z.real()));
        z = {real, 0.5 * z.imag() / real};
        factor *= 2.0;
    }
    double const tangent = z.imag() / z.real(), square = tangent * tangent;
    double sum = 0.0;
    for (int k = 15; k > 0; k -= 2) sum = 1.0 / k - square * sum;
    double const angle = factor * tangent * sum;
    if (x / length >= -0.5) return angle;
    return y < 0.0 ? angle - std::numbers::pi : angle + std::numbers::pi;
}

/// e^(i angle)
inline std::complex<double> MakeUnit(double angle) {
    constexpr double kQuarter = 0.5 * std::numbers::pi;
    double const turns = std::nearbyint(angle / kQuarter), rest = angle - turns * kQuarter;
    std::complex<double> term(1.0, 0.0), sum = term;
    for (int k = 1; k <= 20; ++k) {
        term *= std::complex<double>(0.0, rest / k);
        sum += term;
    }
    switch (static_cast<long long>(turns) & 3) {
        case 1:
            return {-sum.imag(), sum.real()};
        case 2:
            return -sum;
        case 3:
            return {sum.imag(), -sum.real()};
        default:
            return sum;
    }
}

}  // namespace limn::eval
