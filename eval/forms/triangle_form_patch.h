// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/types.h"

namespace limn::eval {

/// The limit of a 1-form in a triangle among regular ones (Loop, all three corners of valence 6): a
/// quartic polynomial per component, from the 24 edges of the triangle's neighbourhood.
///
/// The polynomials are not written down: on a lattice the exact limits at the 15 vertices of a
/// triangle refined twice are known (VertexCovectors), and 15 points determine a quartic.
///
/// Source  [Wang06] Sec. 4.1; [Forms 7.2], [Forms 7.3]
class TriangleFormPatch {
public:
    /// False, and nothing done, if the triangle is not regular.
    bool Bind(Far::TopologyLevel const& level, Index face, std::span<double const> form);

    /// Components along the sides from corner 0 to 1 (s) and from 0 to 2 (t).
    std::array<double, 2> Evaluate(double s, double t) const;

    static constexpr size_t kNumTerms = 15;
    using Terms = std::array<double, kNumTerms>;

private:
    std::array<Terms, 2> _coefficients{};
};

}  // namespace limn::eval
