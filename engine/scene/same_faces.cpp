// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/same_faces.h"

namespace limn::engine {

using far_ext::ControlMesh;

bool HaveSameFaces(ControlMesh const& a, ControlMesh const& b) {
    return a.faceVertices == b.faceVertices && a.faceSizes == b.faceSizes;
}

std::optional<FaceDifference> FindFaceDifference(ControlMesh const& a, ControlMesh const& b) {
    using Kind = FaceDifference::Kind;
    if (a.numVertices != b.numVertices)
        return FaceDifference{Kind::NumVertices, a.numVertices, b.numVertices};
    if (a.GetNumFaces() != b.GetNumFaces())
        return FaceDifference{Kind::NumFaces, a.GetNumFaces(), b.GetNumFaces()};
    size_t corner = 0;
    for (Index face = 0; face < a.GetNumFaces(); ++face) {
        int const size = a.faceSizes[face];
        if (size != b.faceSizes[face])
            return FaceDifference{Kind::FaceSize, size, b.faceSizes[face], face};
        for (int i = 0; i < size; ++i, ++corner) {
            Index const vertexA = a.faceVertices[corner], vertexB = b.faceVertices[corner];
            if (vertexA != vertexB) return FaceDifference{Kind::Vertex, vertexA, vertexB, face, i};
        }
    }
    return std::nullopt;
}

}  // namespace limn::engine
