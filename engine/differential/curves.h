// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/scene/job.h"
#include "eval/differential/curve.h"

namespace limn::engine {

struct CurveOptions {
    eval::CurveRule rule = eval::CurveRule::CubicBSpline;
    int levels = 1;
    bool isDifferential = false;  ///< as eval::RefineCurveDifferentially
};

struct RefinedCurves {
    std::vector<eval::Curve> curves;
    eval::CurveReport worst;  ///< the largest values of all curves; 0 in space
};

/// \throws Stopped
RefinedCurves RefineCurves(std::vector<eval::Curve> const& curves, CurveOptions const& options,
                           Job& job);

}  // namespace limn::engine
