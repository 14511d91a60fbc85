// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/types.h"

namespace limn::eval {

/// A vector that a field is to have at the middle of a face, or at a vertex (there the mean of the
/// faces round it, by area).
struct WantedVector {
    bool isFace = true;
    Index element = 0;
    std::array<double, 3> vector{};
};

/// The 1-form whose field is nearest to the wanted vectors: least squares, weighted by area. What
/// the vectors leave open is filled in smoothly: curl and divergence count 1e-6 as much.
///
/// \param positions  3 per vertex of the level
/// \throws Error     as far_ext::FindHodgeStars
/// Source            [Wang06] Sec. 4.2; [Forms 8]
std::vector<double> MatchVectors(Far::TopologyLevel const& level, std::span<double const> positions,
                                 std::span<WantedVector const> wanted);

}  // namespace limn::eval
