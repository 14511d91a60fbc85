// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/types.h"

namespace limn::eval {

/// A vertex inside of a surface, and the index that a field is to have there: 1 like a source or a
/// vortex, -1 like a saddle.
struct WantedIndex {
    Index vertex;
    int index;
};

/// A field of unit vectors with singularities where they are wanted and nowhere else: unit vectors
/// in the planes of faces, carried from face to face by the connection that turns the least and
/// whose holonomy is a whole number of turns round every vertex, handle and hole; as the 1-form of
/// the mean of both faces' vectors along each edge. 0 on components without any wanted index.
///
/// Equations  d0^T x = K - 2 pi k at the vertices inside, K what a vertex' corners lack of 2 pi;
///            the least sum of x^2 / *1; then harmonic x that make the other holonomies whole.
/// \param positions  3 per vertex
/// \pre       CheckForms has passed; vertices inside, each once; on a closed component indices that
///            add up to its Euler characteristic
/// \throws Error  as FieldDesigner
/// Source     [Crane10]; [Forms 14]
std::vector<double> MakeUnitField(Far::TopologyLevel const& level,
                                  std::span<double const> positions,
                                  std::span<WantedIndex const> wanted);

}  // namespace limn::eval
