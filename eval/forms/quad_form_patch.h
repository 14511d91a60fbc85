// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/types.h"

namespace limn::eval {

/// The limit of a 1-form in a quad among regular ones (Catmull-Clark, all four corners of valence
/// 4): quadratic B-splines along the edges times cubic ones across, over the 24 edges of the 3 x 3
/// quads round it.
///
/// Source  [Forms 7.3]; [Forms 4] has the tensor product of which this is the limit
class QuadFormPatch {
public:
    /// False, and nothing done, if the quad is not regular.
    bool Bind(Far::TopologyLevel const& level, Index face, std::span<double const> form);

    /// Components along s (from corner 0 to 1) and t (from corner 0 to 3).
    std::array<double, 2> Evaluate(double s, double t) const;

private:
    double _alongS[3][4] = {}, _alongT[4][3] = {};  // [column][row]
};

}  // namespace limn::eval
