// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/types.h"

namespace limn::eval {

/// A vertex and the value that a function is to have there.
struct Pin {
    Index vertex;
    double value;
};

/// The function on vertices that has the pins' values and is harmonic between them:
/// d0^T *1 d0 f = 0 at all others. 0 on components without pins.
///
/// \param edgeStars  *1, per edge  \param pins  each vertex once
/// \throws Error     as LaplaceSolver
/// Source            [Forms 8]
std::vector<double> MakeHarmonicFunction(Far::TopologyLevel const& level,
                                         std::span<double const> edgeStars,
                                         std::span<Pin const> pins);

}  // namespace limn::eval
