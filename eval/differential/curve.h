// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "eval/differential/lanes.h"

namespace limn::eval {

/// A polyline: points in order; a closed one joins its last to its first.
struct Curve {
    std::vector<DoubleLanes> points;  ///< the fourth lane is 0
    bool isClosed = false;
};

enum class CurveRule {
    CubicBSpline,  ///< (1/8, 3/4, 1/8) and (1/2, 1/2)
    FourPoint  ///< points stay; (-1, 9, 9, -1)/16, with what is missing at an end reflected there
};

/// One step: points and edges' new points alternate. Ends of an open curve stay.
///
/// \pre at least 3 points (open: 2)
Curve SubdivideCurve(Curve const& coarse, CurveRule rule);

/// delta_i = v_i - (v_(i-1) + v_(i+1)) / 2. An open curve's ends take their neighbour's (of 2
/// points: 0).
///
/// Source  [Zhu11] eq. (8)
std::vector<DoubleLanes> FindCurveDeltas(Curve const& curve);

/// The closed curve with given deltas whose first point is 0, by summing twice; their mean, which
/// none has, is taken away. \return |sum delta| / sum |delta|
double SolveClosedCurve(std::vector<DoubleLanes> const& deltas, std::vector<DoubleLanes>& points);

/// The open curve with given deltas (those of the ends are not used) between given ends.
void SolveOpenCurve(std::vector<DoubleLanes> const& deltas, DoubleLanes const& first,
                    DoubleLanes const& last, std::vector<DoubleLanes>& points);

/// What became of a curve in differential space.
struct CurveReport {
    double residual = 0.0;  ///< |L V - Delta| / |Delta|, after projection
    double compatibilityDefect = 0.0;
};

struct CurveResult {
    Curve curve;
    CurveReport report;
};

/// Subdivides a curve's differential coordinates and finds the curve that has them: a closed one
/// with its first point, an open one with its ends where the rule itself puts them.
///
/// Source  [Zhu11] Sec. 3.5, curve case
CurveResult RefineCurveDifferentially(Curve const& coarse, CurveRule rule, int levels);

}  // namespace limn::eval
