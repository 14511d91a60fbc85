// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/extent.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limn::engine {

namespace {

/// Of numbers with so many binary digits, down to 2^smallestExponent.
double GetStep(double value, int numDigits, int smallestExponent) {
    int const exponent = value == 0.0 ? smallestExponent : std::ilogb(value) - numDigits + 1;
    return std::ldexp(1.0, std::max(exponent, smallestExponent));
}

}  // namespace

double Extent::GetDiagonal() const {
    double squares = 0.0;
    for (size_t c = 0; c < 3; ++c) squares += (high[c] - low[c]) * (high[c] - low[c]);
    return std::sqrt(squares);
}

double Extent::GetFarthest() const {
    double farthest = 0.0;
    for (size_t c = 0; c < 3; ++c)
        farthest = std::max({farthest, std::abs(low[c]), std::abs(high[c])});
    return farthest;
}

Extent FindExtent(std::span<double const> positions) {
    Extent extent;
    if (positions.empty()) return extent;
    std::copy_n(positions.begin(), 3, extent.low.begin());
    extent.high = extent.low;
    for (size_t i = 3; i < positions.size(); ++i) {
        extent.low[i % 3] = std::min(extent.low[i % 3], positions[i]);
        extent.high[i % 3] = std::max(extent.high[i % 3], positions[i]);
    }
    return extent;
}

double FindGrowth(Extent const& before, Extent const& after) {
    double longest = 0.0, reach = 0.0;
    for (size_t c = 0; c < 3; ++c) {
        double const middle = 0.5 * before.low[c] + 0.5 * before.high[c];
        longest = std::max(longest, 0.5 * (before.high[c] - before.low[c]));
        reach = std::max({reach, after.high[c] - middle, middle - after.low[c]});
    }
    return longest > 0.0 ? reach / longest : 1.0;
}

double GetFloatStep(double value) {
    return GetStep(value, 24, -149);
}

double GetHalfStep(double value) {
    return GetStep(value, 11, -24);
}

double FindFloatError(Extent const& extent) {
    constexpr double kHalfOfTheSmallest = 0x1p-150;
    double const farthest = extent.GetFarthest();
    if (farthest > std::numeric_limits<float>::max()) return farthest;
    return farthest > 0.0 ? std::max(0x1p-24 * farthest, kHalfOfTheSmallest) : 0.0;
}

bool AreFloatsEnough(Extent const& extent, double share) {
    return FindFloatError(extent) <= share * extent.GetDiagonal();
}

std::array<double, 3> FindOrigin(Extent const& extent) {
    double const diagonal = extent.GetDiagonal();
    if (!(diagonal > 0.0)) return extent.low;
    double const unit = std::ldexp(1.0, std::ilogb(diagonal));
    std::array<double, 3> origin;
    for (size_t c = 0; c < 3; ++c) {
        double const middle = 0.5 * extent.low[c] + 0.5 * extent.high[c];
        origin[c] = unit * std::round(middle / unit) + 0.0;  // of both zeros the positive one
    }
    return origin;
}

std::array<double, 3> FindFloatOrigin(Extent const& extent) {
    return AreFloatsEnough(extent) ? std::array<double, 3>{} : FindOrigin(extent);
}

std::vector<double> Subtract(std::span<double const> positions,
                             std::array<double, 3> const& origin) {
    std::vector<double> relative(positions.begin(), positions.end());
    for (size_t i = 0; i < relative.size(); ++i) relative[i] -= origin[i % 3];
    return relative;
}

}  // namespace limn::engine
