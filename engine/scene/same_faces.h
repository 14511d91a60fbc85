// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "engine/scene/model.h"

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

/// \param purpose  what needs the same faces, for the message: "a morph"
/// \throws Error   BadMesh, naming the first difference
void RequireSameFaces(Model const& a, Model const& b, std::string_view purpose);

}  // namespace limn::engine
