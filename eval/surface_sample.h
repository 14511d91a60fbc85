// SPDX-License-Identifier: Apache-2.0
#pragma once

// Where programs found this header up to 0.1; it goes with 0.3. Include
// <limn/eval/surface/surface_sample.h>.
#include "eval/surface/surface_sample.h"

namespace limn::eval {

/// As it was called in 0.1, with the sign of the orientation: 1 for Right, -1 for Left.
inline SurfaceSample EvaluateSample(FaceTree& tree, int domain, double s, double t, double sign) {
    return EvaluateSample(tree, domain, s, t, sign < 0.0 ? Orientation::Left : Orientation::Right);
}

}  // namespace limn::eval
