// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "eval/surface/polynomial_bounds.h"
#include "far_ext/rings/ring_subdivision.h"

namespace limn::engine {

/// A polynomial piece of the texture map, in texels about a whole-numbered origin.
struct TexturePiece {
    double coefficients[2][16];  ///< see patch_polynomial.h; 15 used on a triangle
    double originX = 0.0, originY = 0.0;
    eval::PolynomialBounds bounds[2];  ///< per coordinate
    far_ext::SubDomain domain;         ///< of the piece within the face's domain
    bool isTriangle = false;

    double GetCentre() const;

    /// Value, d/dx, d/dy of one coordinate at (x, y) about the piece's centre.
    std::array<double, 3> Evaluate(int coordinate, double x, double y) const;

    /// Bound of how far a coordinate strays from its linear part within `half` of a place.
    double GetStray(int coordinate, double half) const { return bounds[coordinate].GetStray(half); }

    /// Fills the bounds from the coefficients.
    void FindBounds();

    /// True if the piece is squeezed to a curve or a point: it covers no area to speak of.
    bool IsCollapsed() const;
};

enum class SearchResult { Found, NotThere, Undecided };

/// Looks for (s, t) in the piece's domain with map(s, t) within `tolerance` texels of the target,
/// where Newton's method alone gave no answer: cuts the domain into quarters, drops those whose
/// bounds exclude the target, and starts Newton from the others.
SearchResult SearchPiece(TexturePiece const& piece, double targetX, double targetY,
                         double tolerance, double& s, double& t);

}  // namespace limn::engine
