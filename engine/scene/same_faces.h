// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "far_ext/topology/control_mesh.h"

namespace limn::engine {

/// True if two meshes have the same faces of the same vertices in the same order. Vertices that no
/// face uses may differ in number.
bool HaveSameFaces(far_ext::ControlMesh const& a, far_ext::ControlMesh const& b);

/// The first thing in which the faces of two meshes differ: a number in `a` that is another in `b`.
struct FaceDifference {
    enum class Kind { NumVertices, NumFaces, FaceSize, Vertex };
    Kind kind;
    int a, b;
    Index face = -1;  ///< of FaceSize and Vertex
    int corner = -1;  ///< of Vertex
};

/// Nothing where both have the same number of vertices, and HaveSameFaces.
std::optional<FaceDifference> FindFaceDifference(far_ext::ControlMesh const& a,
                                                 far_ext::ControlMesh const& b);

}  // namespace limn::engine
