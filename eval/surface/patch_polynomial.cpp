// SPDX-License-Identifier: Apache-2.0
#include "eval/surface/patch_polynomial.h"

#include <cmath>
#include <map>

#include <Eigen/Dense>

#include "far_ext/rings/ring_subdivision.h"

namespace limn::eval {

namespace {

// Uniform cubic B-spline in powers of x = s - 1/2 (rows: power, columns: control point).
constexpr double kBSpline[4][4] = {{1.0 / 48, 23.0 / 48, 23.0 / 48, 1.0 / 48},
                                   {-1.0 / 8, -5.0 / 8, 5.0 / 8, 1.0 / 8},
                                   {1.0 / 4, -1.0 / 4, -1.0 / 4, 1.0 / 4},
                                   {-1.0 / 6, 1.0 / 2, -1.0 / 2, 1.0 / 6}};

using BoxMatrix = Eigen::Matrix<double, kTriangleCoefficients, 12>;

/// Limit of regular Loop subdivision on the triangular lattice: values at the integer points of
/// level `level`, for a control value of 1 at one lattice point.
using LatticeValues = std::map<std::array<int, 2>, double>;

constexpr int kNeighbours[6][2] = {{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}};

LatticeValues SubdivideLattice(LatticeValues const& coarse) {
    LatticeValues fine;
    for (auto const& [place, value] : coarse) {
        auto const [i, j] = place;
        fine[{2 * i, 2 * j}] += value * 10 / 16;
        for (auto const& step : kNeighbours) {
            fine[{2 * (i + step[0]), 2 * (j + step[1])}] += value / 16;
            fine[{2 * i + step[0], 2 * j + step[1]}] += value * 3 / 8;
        }
        // The edges opposite to a vertex, one per triangle at it, get 1/8.
        for (int k = 0; k < 6; ++k) {
            auto const& a = kNeighbours[k];
            auto const& b = kNeighbours[(k + 1) % 6];
            fine[{2 * i + a[0] + b[0], 2 * j + a[1] + b[1]}] += value / 8;
        }
    }
    return fine;
}

/// The quartic that interpolates the limit at the 15 points (i/4, j/4) is the patch itself, since
/// the patch is a quartic. Values on the lattice are dyadic but for the limit mask's 1/12.
BoxMatrix MakeBoxMatrix() {
    Eigen::Matrix<double, 15, 15> powers;
    Eigen::Matrix<double, 15, 12> values;
    int row = 0;
    std::array<LatticeValues, 12> splines;
    for (int point = 0; point < 12; ++point) {
        LatticeValues const start{{far_ext::kBoxSplineLattice[point], 1.0}};
        splines[point] = SubdivideLattice(SubdivideLattice(start));
    }
    for (int j = 0; j <= 4; ++j) {
        for (int i = 0; i + j <= 4; ++i, ++row) {
            for (int point = 0; point < 12; ++point) {
                auto const at = [&](int a, int b) {
                    auto const found = splines[point].find({a, b});
                    return found == splines[point].end() ? 0.0 : found->second;
                };
                double limit = at(i, j) / 2;
                for (auto const& step : kNeighbours) limit += at(i + step[0], j + step[1]) / 12;
                values(row, point) = limit;
            }
            double const x = i / 4.0 - kTriangleCentre, y = j / 4.0 - kTriangleCentre;
            int column = 0;
            double yPower = 1.0;
            for (int b = 0; b <= 4; ++b, yPower *= y) {
                double xPower = 1.0;
                for (int a = 0; a + b <= 4; ++a, xPower *= x)
                    powers(row, column++) = xPower * yPower;
            }
        }
    }
    return powers.fullPivLu().solve(values);
}

BoxMatrix const& GetBoxMatrix() {
    static BoxMatrix const matrix = MakeBoxMatrix();
    return matrix;
}

}  // namespace

void BSplineToPower(double const* points, int stride, double* coefficients) {
    double half[4][4];  // [t row][power of x]
    for (int t = 0; t < 4; ++t) {
        double const* const line = points + 4 * t * stride;
        for (int i = 0; i < 4; ++i) {
            half[t][i] = kBSpline[i][0] * line[0] + kBSpline[i][1] * line[stride] +
                         kBSpline[i][2] * line[2 * stride] + kBSpline[i][3] * line[3 * stride];
        }
    }
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
            coefficients[4 * j + i] = kBSpline[j][0] * half[0][i] + kBSpline[j][1] * half[1][i] +
                                      kBSpline[j][2] * half[2][i] + kBSpline[j][3] * half[3][i];
        }
    }
}

void BoxSplineToPower(double const* points, int stride, double* coefficients) {
    BoxMatrix const& matrix = GetBoxMatrix();
    for (int row = 0; row < kTriangleCoefficients; ++row) {
        double sum = 0.0;
        for (int point = 0; point < 12; ++point) sum += matrix(row, point) * points[point * stride];
        coefficients[row] = sum;
    }
}

std::array<double, 6> EvaluateQuadPolynomial(double const* c, double x, double y) {
    double value[4], first[4],
        second[4];  // per power of y: the polynomial in x and its derivatives
    for (int j = 0; j < 4; ++j, c += 4) {
        value[j] = ((c[3] * x + c[2]) * x + c[1]) * x + c[0];
        first[j] = (3 * c[3] * x + 2 * c[2]) * x + c[1];
        second[j] = 6 * c[3] * x + 2 * c[2];
    }
    auto const cubic = [&](double const* p) { return ((p[3] * y + p[2]) * y + p[1]) * y + p[0]; };
    auto const slope = [&](double const* p) { return (3 * p[3] * y + 2 * p[2]) * y + p[1]; };
    return {cubic(value),  cubic(first), slope(value),
            cubic(second), slope(first), 6 * value[3] * y + 2 * value[2]};
}

std::array<double, 6> EvaluateTrianglePolynomial(double const* c, double x, double y) {
    double value[5], first[5], second[5];
    for (int j = 0; j < 5; ++j) {
        int const degree = 4 - j;
        value[j] = first[j] = second[j] = 0.0;
        for (int i = degree; i >= 0; --i) {
            second[j] = second[j] * x + 2 * first[j];
            first[j] = first[j] * x + value[j];
            value[j] = value[j] * x + c[i];
        }
        c += degree + 1;
    }
    std::array<double, 6> result{};
    for (int j = 4; j >= 0; --j) {  // the same Horner scheme, in y
        result[5] = result[5] * y + 2 * result[2];
        result[4] = result[4] * y + result[1];
        result[2] = result[2] * y + result[0];
        result[0] = result[0] * y + value[j];
        result[1] = result[1] * y + first[j];
        result[3] = result[3] * y + second[j];
    }
    return result;
}

}  // namespace limn::eval
