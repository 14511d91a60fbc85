// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/types.h"

namespace limn::far_ext {

// The edges of a level of a refinement, and the curves that those with one face make.

/// The other end of an edge.
inline Index GetOtherEnd(Far::TopologyLevel const& level, Index edge, Index vertex) {
    auto const ends = level.GetEdgeVertices(edge);
    return ends[0] == vertex ? ends[1] : ends[0];
}

/// Mean length of the edges; 0 without any.
///
/// \param positions  3 per vertex of the level
double FindMeanEdgeLength(Far::TopologyLevel const& level, std::span<double const> positions);

/// The neighbours of a vertex along the boundary, in the order of its edges; {-1, -1} inside.
///
/// \pre CheckBoundary has passed
std::array<Index, 2> GetBoundaryNeighbours(Far::TopologyLevel const& level, Index vertex);

/// \throws Error  BadMesh: a vertex with other than 0 or 2 boundary edges, so that boundary curves
///                meet there
void CheckBoundary(Far::TopologyLevel const& level);

/// The boundary curves, each a cycle of vertices that starts at its lowest index; sorted by that
/// index.
///
/// \pre CheckBoundary has passed
std::vector<std::vector<Index>> FindBoundaryLoops(Far::TopologyLevel const& level);

}  // namespace limn::far_ext
