// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/same_faces.h"

#include <string>

#include <fmt/format.h>

#include "far_ext/error.h"

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

namespace {

std::string DescribeDifference(Model const& a, Model const& b, FaceDifference const& difference) {
    switch (difference.kind) {
        case FaceDifference::Kind::NumVertices:
            return fmt::format("{} and {} vertices", difference.a, difference.b);
        case FaceDifference::Kind::NumFaces:
            return fmt::format("{} and {} faces", difference.a, difference.b);
        default:
            return fmt::format("{} has other vertices than {}", a.NameFace(difference.face),
                               b.NameFace(difference.face));
    }
}

}  // namespace

void RequireSameFaces(Model const& a, Model const& b, std::string_view purpose) {
    auto const difference = FindFaceDifference(a.GetCage(), b.GetCage());
    if (!difference) return;
    throw Error(
        ErrorCode::BadMesh,
        fmt::format("{} and {} do not have the same faces: {}; {} needs the same vertices "
                    "and faces in the same order",
                    a.GetPath(), b.GetPath(), DescribeDifference(a, b, *difference), purpose));
}

}  // namespace limn::engine
