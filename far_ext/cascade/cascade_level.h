// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "far_ext/types.h"

namespace limn::far_ext {

/// One level of a cascade as faces, in the public vertex order: a mesh and how it hangs on the
/// coarser one.
struct CascadeMesh {
    Index numVertices = 0;
    int faceSize = 3;                   ///< 3 or 4 corners in every face
    std::vector<Index> faces;           ///< corners, face after face
    std::vector<int> parentOffsets{0};  ///< per vertex, one more: into parents
    std::vector<Index> parents;  ///< vertices of the coarser mesh; a vertex starts at their mean
    std::vector<std::array<Index, 2>> creases;  ///< edges across which nothing is smoothed
    std::vector<Index> corners;                 ///< vertices that stay

    Index GetNumFaces() const { return static_cast<Index>(faces.size()) / faceSize; }
};

/// A level of a uniform refinement: vertices stay, edges are halved, faces of Catmull-Clark and
/// bilinear refinement get their centre. Creases and corners are those whose sharpness lasts to
/// this level.
///
/// \param level   0 to the last; on level 0 each vertex is its own parent
/// \throws Error  BadMesh: on level 0, a face (named) that is neither a triangle nor a quad, or not
///                as all others
CascadeMesh MakeCascadeMesh(Far::TopologyRefiner const& refiner, int level);

/// What happens at boundaries.
enum class BoundaryRule {
    Fixed,   ///< X = X0
    Natural  ///< no conormal derivative: boundary triangles degenerate with the levels
};

/// A level ready for sweeps: per row its ring of neighbours. Rows of each kind are numbered
/// breadth-first along the rings, see far_ext/rows/breadth_first.h.
///
/// Order    surface rows with a closed ring; with an open one; rows on creases; rows that stay.
/// Ring     on triangles a, b, c ... counter-clockwise; on quads edge neighbours and opposite
///          corners in turn, a, ab, b, bc, c ...; an open ring ends with an edge neighbour. Of a
///          row on a crease: its two neighbours along the crease. None for rows that stay.
/// Source   [Diewald02] Sec. 7, Fig. 8
struct CascadeLevel {
    int faceSize = 3;
    Index numClosed = 0, numSurface = 0,
          numUnknowns = 0;           ///< ends of the first three kinds of rows
    std::vector<Index> vertices;     ///< per row: vertex of the level
    std::vector<int> offsets;        ///< per unknown, one more: into neighbours
    std::vector<Index> neighbours;   ///< rows
    std::vector<int> parentOffsets;  ///< per row, one more: into parents
    std::vector<Index> parents;      ///< rows of the coarser level
    Index bandwidth = std::numeric_limits<Index>::max();  ///< at least the difference of neighbours
                                                          ///< that are both unknowns

    Index GetNumRows() const { return static_cast<Index>(vertices.size()); }
};

/// \param coarseVertices  `vertices` of the coarser level; empty where that is in its public order
/// \throws Error  BadMesh: a vertex whose faces are no disc or half-disc of one orientation.
///                TooLarge
CascadeLevel BuildCascadeLevel(CascadeMesh const& mesh, std::span<Index const> coarseVertices,
                               BoundaryRule rule);

}  // namespace limn::far_ext
