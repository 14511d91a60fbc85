// SPDX-License-Identifier: Apache-2.0
#include "engine/differential/monotone_curve.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace limn::engine {

MonotoneCurve::MonotoneCurve(std::vector<std::array<double, 2>> points)
    : _points(std::move(points)) {
    std::vector<double> secants;
    for (size_t i = 0; i + 1 < _points.size(); ++i) {
        auto const [x, y] = _points[i];
        secants.push_back((_points[i + 1][1] - y) / (_points[i + 1][0] - x));
    }
    _slopes.push_back(secants.front());
    for (size_t i = 0; i + 1 < secants.size(); ++i) {
        bool const isExtreme = !(secants[i] * secants[i + 1] > 0.0);
        _slopes.push_back(isExtreme ? 0.0 : 0.5 * (secants[i] + secants[i + 1]));
    }
    _slopes.push_back(secants.back());
    // A cubic is monotone where its end slopes, over the secant, lie in a circle of radius 3.
    for (size_t i = 0; i < secants.size(); ++i) {
        double& first = _slopes[i];
        double& last = _slopes[i + 1];
        double const size = std::sqrt(first * first + last * last),
                     most = 3.0 * std::abs(secants[i]);
        if (size <= most) continue;
        first *= most / size;
        last *= most / size;
    }
}

double MonotoneCurve::operator()(double x) const {
    if (x <= _points.front()[0]) return _points.front()[1];
    if (x >= _points.back()[0]) return _points.back()[1];
    auto const after = std::ranges::upper_bound(
        _points, x, {}, [](std::array<double, 2> const& point) { return point[0]; });
    size_t const i = static_cast<size_t>(after - _points.begin()) - 1;
    auto const [x0, y0] = _points[i];
    auto const [x1, y1] = _points[i + 1];
    double const width = x1 - x0, t = (x - x0) / width, rest = 1.0 - t;
    return rest * rest * ((1.0 + 2.0 * t) * y0 + t * width * _slopes[i]) +
           t * t * ((1.0 + 2.0 * rest) * y1 - rest * width * _slopes[i + 1]);
}

}  // namespace limn::engine
