// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

namespace limn::engine {

/// A curve through points that rises where they rise, falls where they fall, and has no extremes
/// but theirs: cubics with the mean of both secants for slope, cut back where that overshoots.
/// Beyond the ends it keeps their values.
///
/// Source  [Fritsch80]
class MonotoneCurve {
public:
    /// \pre two points (x, y) at least, x rising
    explicit MonotoneCurve(std::vector<std::array<double, 2>> points);

    double operator()(double x) const;

private:
    std::vector<std::array<double, 2>> _points;
    std::vector<double> _slopes;
};

}  // namespace limn::engine
