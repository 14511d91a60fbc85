// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "far_ext/types.h"

namespace limn::eval {

/// A vector that a field is to have: that of a face, as far_ext::BuildFaceVectors has it, or that
/// of the limit at a vertex, as VertexCovectors has it.
struct WantedVector {
    bool isFace = true;
    Index element = 0;
    std::array<double, 3> vector{};
};

/// The 1-form whose field is nearest to the wanted vectors: least squares, weighted by area. What
/// the vectors leave open is filled in smoothly, with the least curl and divergence; what they
/// hardly tell does not follow their noise. Vectors that some form has are met to 1e-5 and better,
/// those of few sources and vortices to rounding.
///
/// Own fields  Vectors at all vertices or at all faces do not determine a form: of sides that
///             alternate they see the mean. If one that few sources and vortices make has these
///             vectors, it is taken; which gives back what FieldDesigner made, and subdivided forms
///             but for a few hundredths between the places.
/// \param refiner    unrefined topology that far_ext::CheckForms has passed
/// \param positions  3 per vertex
/// \param onStep     called now and then; may throw to end the work
/// \throws Error     as far_ext::FindHodgeStars; BadOption: a face or vertex that does not exist
/// Source            [Wang06] Sec. 4.2; [Forms 8]
std::vector<double> MatchVectors(Far::TopologyRefiner const& refiner,
                                 std::span<double const> positions,
                                 std::span<WantedVector const> wanted,
                                 std::function<void()> const& onStep = {});

}  // namespace limn::eval
