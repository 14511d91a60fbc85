// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <Eigen/Core>

namespace limn::test {

/// Numbers from -1 to 1, the same for the same seed.
inline std::vector<float> MakeRandomValues(size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<float> values;
    values.reserve(count);
    while (values.size() < count) values.push_back(static_cast<float>(random()) * 0x1p-31f - 1.0f);
    return values;
}

inline std::vector<double> MakeNoise(size_t count, unsigned seed) {
    auto const values = MakeRandomValues(count, seed);
    return {values.begin(), values.end()};
}

/// Points, or rows of another length, as a matrix.
using Rows = Eigen::Matrix<double, -1, -1, Eigen::RowMajor>;
inline Rows ToRows(std::vector<double> const& values, int length = 3) {
    return Eigen::Map<Rows const>(values.data(), static_cast<Eigen::Index>(values.size()) / length,
                                  length);
}

/// The larger of two deviations, of which one that is not a number is infinitely large: std::max
/// would pass over it.
inline double Worse(double worst, double next) {
    if (std::isnan(next)) return std::numeric_limits<double>::infinity();
    return std::max(worst, next);
}

/// The largest magnitude in a matrix or array; none, where one entry is not a number.
template <class Matrix>
double LargestOf(Eigen::DenseBase<Matrix> const& matrix) {
    return matrix.derived().array().abs().template maxCoeff<Eigen::PropagateNaN>();
}

/// Diagonal of the box round points.
inline double BoxDiagonal(std::vector<double> const& points) {
    Rows const rows = ToRows(points);
    return (rows.colwise().maxCoeff() - rows.colwise().minCoeff()).norm();
}

/// Largest difference of two arrays, without regard to a translation if so asked; infinite where
/// they are not of one size, or empty.
inline double LargestDifference(std::vector<double> const& a, std::vector<double> const& b,
                                bool isUpToTranslation = false) {
    if (a.size() != b.size() || a.empty()) return std::numeric_limits<double>::infinity();
    double shift[3] = {0, 0, 0};
    for (size_t i = 0; isUpToTranslation && i < a.size(); ++i)
        shift[i % 3] += 3.0 * (a[i] - b[i]) / static_cast<double>(a.size());
    double worst = 0.0;
    for (size_t i = 0; i < a.size(); ++i)
        worst = Worse(worst, std::abs(a[i] - b[i] - shift[i % 3]));
    return worst;
}

/// Largest difference over the largest value of `expected`.
inline double RelativeDifference(std::vector<float> const& found,
                                 std::vector<float> const& expected) {
    double largest = 0.0;
    for (float value : expected) largest = Worse(largest, std::abs(static_cast<double>(value)));
    return LargestDifference({found.begin(), found.end()}, {expected.begin(), expected.end()}) /
           (largest > 0.0 ? largest : 1.0);
}

inline bool AreFinite(std::vector<double> const& values) {
    return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace limn::test
