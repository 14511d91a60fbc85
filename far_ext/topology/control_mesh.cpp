// SPDX-License-Identifier: Apache-2.0
#include "far_ext/topology/control_mesh.h"

#include <fmt/format.h>
#include <opensubdiv/vtr/types.h>

#include "far_ext/error.h"

namespace limn::far_ext {

Sdc::Options ControlMesh::DefaultOptions() {
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1);
    options.SetCreasingMethod(Sdc::Options::CREASE_UNIFORM);
    options.SetTriangleSubdivision(Sdc::Options::TRI_SUB_CATMARK);
    return options;
}

namespace {

[[noreturn]] void Refuse(ErrorCode code, std::string const& message) {
    throw Error(code, message);
}

void ValidateFaces(ControlMesh const& mesh) {
    constexpr int kValenceLimit = OpenSubdiv::Vtr::VALENCE_LIMIT;
    // Every face contributes one face and at most two edges to each of its vertices.
    std::vector<int> valences(mesh.numVertices, 0);
    size_t corner = 0;
    for (Index face = 0; face < mesh.GetNumFaces(); ++face) {
        int const size = mesh.faceSizes[face];
        if (size < 3) {
            Refuse(ErrorCode::BadMesh,
                   fmt::format("face {} has {} corners; a face has at least 3", face, size));
        }
        if (size > kValenceLimit) {
            Refuse(ErrorCode::TooLarge,
                   fmt::format("face {} has {} corners; at most {} are possible", face, size,
                               kValenceLimit));
        }
        if (mesh.scheme == Sdc::SCHEME_LOOP && size != 3) {
            Refuse(ErrorCode::BadMesh,
                   fmt::format("face {} has {} corners; the loop scheme takes triangles only "
                               "(use `scheme` catmark)",
                               face, size));
        }
        if (corner + static_cast<size_t>(size) > mesh.faceVertices.size()) {
            Refuse(ErrorCode::BadMesh, fmt::format("face {}: its corners are missing", face));
        }
        for (int i = 0; i < size; ++i, ++corner) {
            Index const vertex = mesh.faceVertices[corner];
            if (vertex < 0 || vertex >= mesh.numVertices) {
                Refuse(ErrorCode::BadMesh,
                       fmt::format("face {} uses vertex {}; there are {} vertices", face, vertex,
                                   mesh.numVertices));
            }
            if (++valences[vertex] > kValenceLimit / 2) {
                Refuse(ErrorCode::TooLarge,
                       fmt::format("vertex {} has more than {} faces; OpenSubdiv holds no more",
                                   vertex, kValenceLimit / 2));
            }
        }
    }
    if (corner != mesh.faceVertices.size()) {
        Refuse(ErrorCode::BadMesh, "there are more corners than the faces use");
    }
}

void ValidateTags(ControlMesh const& mesh) {
    auto const isVertex = [&](Index v) { return v >= 0 && v < mesh.numVertices; };
    auto const isSharpness = [](float s) { return s >= 0.0f; };  // false for NaN too

    if (mesh.creaseVertexPairs.size() != 2 * mesh.creaseSharpness.size()) {
        Refuse(ErrorCode::BadMesh,
               fmt::format("creases: {} vertices and {} sharpnesses; each needs two and one",
                           mesh.creaseVertexPairs.size(), mesh.creaseSharpness.size()));
    }
    if (mesh.cornerVertices.size() != mesh.cornerSharpness.size()) {
        Refuse(ErrorCode::BadMesh,
               fmt::format("corners: {} vertices and {} sharpnesses; each needs one and one",
                           mesh.cornerVertices.size(), mesh.cornerSharpness.size()));
    }
    for (size_t i = 0; i < mesh.creaseSharpness.size(); ++i) {
        Index const a = mesh.creaseVertexPairs[2 * i], b = mesh.creaseVertexPairs[2 * i + 1];
        if (!isVertex(a) || !isVertex(b) || !isSharpness(mesh.creaseSharpness[i])) {
            Refuse(
                ErrorCode::BadMesh,
                fmt::format("crease {} ({} {}, sharpness {}): vertices are 0 to {}, sharpness is 0 "
                            "or more",
                            i, a, b, mesh.creaseSharpness[i], mesh.numVertices - 1));
        }
    }
    for (size_t i = 0; i < mesh.cornerSharpness.size(); ++i) {
        if (!isVertex(mesh.cornerVertices[i]) || !isSharpness(mesh.cornerSharpness[i])) {
            Refuse(ErrorCode::BadMesh,
                   fmt::format(
                       "corner {} (vertex {}, sharpness {}): vertices are 0 to {}, sharpness "
                       "is 0 or more",
                       i, mesh.cornerVertices[i], mesh.cornerSharpness[i], mesh.numVertices - 1));
        }
    }
    for (Index hole : mesh.holes) {
        if (hole < 0 || hole >= mesh.GetNumFaces()) {
            Refuse(ErrorCode::BadMesh, fmt::format("hole names face {}; faces are 0 to {}", hole,
                                                   mesh.GetNumFaces() - 1));
        }
    }
}

void ValidateRules(ControlMesh const& mesh) {
    struct Rule {
        char const* name;
        int value, last;
    };
    Sdc::Options const& options = mesh.options;
    for (Rule const& rule :
         {Rule{"scheme", static_cast<int>(mesh.scheme), Sdc::SCHEME_LOOP},
          Rule{"boundary interpolation", options.GetVtxBoundaryInterpolation(),
               Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER},
          Rule{"face-varying interpolation", options.GetFVarLinearInterpolation(),
               Sdc::Options::FVAR_LINEAR_ALL},
          Rule{"creasing method", options.GetCreasingMethod(), Sdc::Options::CREASE_CHAIKIN},
          Rule{"triangle subdivision", options.GetTriangleSubdivision(),
               Sdc::Options::TRI_SUB_SMOOTH}}) {
        if (rule.value >= 0 && rule.value <= rule.last) continue;
        Refuse(ErrorCode::BadMesh, fmt::format("{} {} is none of OpenSubdiv's, which are 0 to {}",
                                               rule.name, rule.value, rule.last));
    }
}

void ValidateChannel(ControlMesh const& mesh, size_t number) {
    FVarChannel const& channel = mesh.fvarChannels[number];
    if (channel.valueIndices.size() != mesh.faceVertices.size()) {
        Refuse(ErrorCode::BadMesh,
               fmt::format("face-varying channel {}: {} indices; {} are needed, one per corner",
                           number, channel.valueIndices.size(), mesh.faceVertices.size()));
    }
    size_t corner = 0;
    for (Index face = 0; face < mesh.GetNumFaces(); ++face) {
        for (size_t const end = corner + static_cast<size_t>(mesh.faceSizes[face]); corner < end;
             ++corner) {
            Index const value = channel.valueIndices[corner];
            if (value >= 0 && value < channel.numValues) continue;
            Refuse(ErrorCode::BadMesh,
                   fmt::format("face-varying channel {}: face {} uses value {}; there are {} "
                               "values",
                               number, face, value, channel.numValues));
        }
    }
}

}  // namespace

void Validate(ControlMesh const& mesh) {
    if (mesh.faceSizes.empty()) Refuse(ErrorCode::BadMesh, "the mesh has no faces");
    if (mesh.numVertices < 1) Refuse(ErrorCode::BadMesh, "the mesh has no vertices");
    ValidateRules(mesh);
    ValidateFaces(mesh);
    ValidateTags(mesh);
    for (size_t number = 0; number < mesh.fvarChannels.size(); ++number)
        ValidateChannel(mesh, number);
}

}  // namespace limn::far_ext
