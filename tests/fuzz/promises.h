// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "engine/scene/model.h"

namespace limn::fuzz {

// What holds of any result.

template <class Values>
bool AreFinite(Values const& values) {
    return std::ranges::all_of(values, [](auto value) { return std::isfinite(value); });
}

/// The room that limits may take: weights of subdivision may be negative, but only by little, so
/// they stay within four times the box of the control points about its middle.
class Hull {
public:
    explicit Hull(std::vector<double> const& points) {
        for (int c = 0; c < 3; ++c) {
            double low = points[c], high = points[c];
            for (size_t i = c; i < points.size(); i += 3) {
                low = std::min(low, points[i]);
                high = std::max(high, points[i]);
            }
            _middle[c] = low / 2 + high / 2;
            _reach[c] = 2 * (high - low);
            _largest = std::max({_largest, std::abs(low), std::abs(high)});
        }
    }

    double GetDiagonal() const { return std::hypot(_reach[0], _reach[1], _reach[2]) / 2; }

    /// \param rounding  relative, of what made the points
    template <class Number>
    bool Holds(std::span<Number const> points, double rounding) const {
        for (size_t i = 0; i < points.size(); ++i) {
            double const distance = std::abs(static_cast<double>(points[i]) - _middle[i % 3]);
            if (!(distance <= _reach[i % 3] + rounding * _largest)) return false;
        }
        return true;
    }

private:
    double _middle[3], _reach[3], _largest = 0.0;
};

/// Requires that limits lie within four times the hull of the model's control points.
void RequireInHull(engine::Model const& model, std::vector<double> const& points);

/// Requires that a result is a mesh again, of finite positions.
void RequireMesh(engine::Scene scene);

/// Requires that a filter's result has finite positions, one for each vertex of the model.
void RequirePositions(engine::Model const& model, std::vector<double> const& positions);

}  // namespace limn::fuzz
