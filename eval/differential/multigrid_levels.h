// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "far_ext/types.h"

namespace limn::eval {

/// Which vertices keep their value in an equation on a mesh. Vertices without an edge always do.
enum class FixedVertices { None, Boundary };

/// One level of a refinement as a graph of unknowns. Rows are numbered breadth-first along edges,
/// fixed vertices after all unknowns, see far_ext/rows/breadth_first.h.
///
/// Transfer  To a finer level a value goes by the mean of its two parents where an edge was split,
///           as it is at vertices, and by the mean of its neighbours at the middle of a face. To a
///           coarser one goes the transpose. With uniform weights on triangles the coarse equation
///           is exactly P^T G P.
struct MultigridLevel {
    /// Unknowns that edges join. Singular: no fixed vertex among them, so that constants are free.
    struct Block {
        Index begin, end;
        bool isSingular;
    };

    Index numUnknowns = 0;
    std::vector<Index> vertices;    ///< per row: vertex of the level
    std::vector<int> offsets;       ///< per unknown, one more: into neighbours
    std::vector<Index> neighbours;  ///< a row per edge, in OpenSubdiv's order of a vertex's edges
    std::vector<std::array<Index, 2>>
        parents;  ///< per unknown: rows of the coarser level; {-1, -1} in a face
    std::vector<Index>
        children;  ///< per unknown: its own row on the finer level; empty on the finest
    std::vector<Block> blocks;     ///< in order; together all unknowns
    bool hasFaceVertices = false;  ///< whether some parents are {-1, -1}

    Index GetNumRows() const { return static_cast<Index>(vertices.size()); }
};

/// Graphs of the levels from `coarsest` to the last, coarsest first.
///
/// \param refiner  uniformly refined, with the last level's full topology
std::vector<MultigridLevel> BuildMultigridLevels(Far::TopologyRefiner const& refiner,
                                                 FixedVertices fixed, int coarsest = 0);

}  // namespace limn::eval
