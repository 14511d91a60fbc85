// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "far_ext/cascade/cascade_level.h"

namespace limn::engine {

// What limn smooth asks of a control mesh, and says of it.

/// Components of a mesh.
struct SmoothComponents {
    int count = 0;
    std::vector<int> ofVertex;  ///< -1 without faces
    std::vector<char> isClosed;
    std::vector<Index> firstVertex;

    explicit SmoothComponents(Far::TopologyLevel const& level);
};

/// Warns of defects that do not matter here.
///
/// \throws Error  BadMesh: not manifold, or not oriented one way
void RefuseDefects(Model const& model, Job& job);

/// Faces must lie side by side in the plane of x and y: all turn the same way, at each corner.
///
/// \throws Error  BadMesh: a face that does not (named)
void RequireGraph(Model const& model);

/// \param member   the option that needs them
/// \throws Error  BadMesh: a face (named) that is no triangle
void RequireTriangles(Model const& model, char const* member);

/// Warns of corners so sharp that triangles degenerate there with the levels.
///
/// \param first   the first level's rows
/// \param widths  per vertex of the first level or of the model, whose vertices are the first ones
///                there; empty: everywhere some
/// Source  [Diewald02] Fig. 9; [Cascade 8]
void WarnOfSharpCorners(Model const& model, far_ext::CascadeLevel const& first,
                        std::vector<double> const& widths, Job& job);

}  // namespace limn::engine
