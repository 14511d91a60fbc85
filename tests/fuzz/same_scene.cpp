// SPDX-License-Identifier: Apache-2.0
#include "fuzz/same_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "engine/io/mesh_reader.h"
#include "engine/io/mesh_writer.h"
#include "fuzz/fuzzer.h"

namespace limn::fuzz {

namespace {

using engine::Scene;

/// Texture coordinates per corner; those of faces without are left out.
std::vector<double> ListCornerUVs(Scene const& scene) {
    std::vector<double> uvs;
    if (!scene.HasUVs()) return uvs;
    size_t corner = 0;
    for (Index face = 0; face < scene.cage.GetNumFaces(); ++face) {
        for (int i = 0; i < scene.cage.faceSizes[face]; ++i, ++corner) {
            if (!scene.HasUVs(face)) continue;
            size_t const value = scene.cage.fvarChannels[0].valueIndices[corner];
            uvs.insert(uvs.end(), {scene.uvs[2 * value], scene.uvs[2 * value + 1]});
        }
    }
    return uvs;
}

/// Which corners have one texture coordinate: per corner, the first that has the same.
std::vector<size_t> ListSharedUVs(Scene const& scene) {
    std::vector<size_t> first;
    if (!scene.HasUVs()) return first;
    std::vector<size_t> seen(scene.uvs.size() / 2, std::numeric_limits<size_t>::max());
    size_t corner = 0;
    for (Index face = 0; face < scene.cage.GetNumFaces(); ++face) {
        for (int i = 0; i < scene.cage.faceSizes[face]; ++i, ++corner) {
            if (!scene.HasUVs(face)) continue;
            size_t& at = seen[scene.cage.fvarChannels[0].valueIndices[corner]];
            at = std::min(at, corner);
            first.push_back(at);
        }
    }
    return first;
}

std::vector<std::string> ListGroupOfFaces(Scene const& scene, size_t kind) {
    engine::FaceGroups const& groups = scene.groups[kind];
    std::vector<std::string> names(scene.cage.faceSizes.size());
    for (size_t face = 0; face < groups.faceGroup.size(); ++face) {
        if (groups.faceGroup[face] >= 0) names[face] = groups.names[groups.faceGroup[face]];
    }
    return names;
}

void RequireSameTags(far_ext::ControlMesh const& a, far_ext::ControlMesh const& b) {
    Require(a.creaseVertexPairs == b.creaseVertexPairs && a.creaseSharpness == b.creaseSharpness,
            "creases read back the same");
    Require(a.cornerVertices == b.cornerVertices && a.cornerSharpness == b.cornerSharpness,
            "corners read back the same");
    Require(a.holes == b.holes, "holes read back the same");
    Require(a.options.GetVtxBoundaryInterpolation() == b.options.GetVtxBoundaryInterpolation() &&
                a.options.GetCreasingMethod() == b.options.GetCreasingMethod() &&
                a.options.GetTriangleSubdivision() == b.options.GetTriangleSubdivision(),
            "rules read back the same");
}

bool IsColour(engine::Primvar const& primvar) {
    return primvar.name == "color" && (primvar.numChannels == 3 || primvar.numChannels == 4);
}

void RequireSamePrimvars(Scene const& a, Scene const& b, bool onlyColour) {
    auto const choose = [&](Scene const& scene) {
        std::vector<engine::Primvar const*> chosen;
        for (auto const& primvar : scene.primvars) {
            if (!onlyColour || IsColour(primvar)) chosen.push_back(&primvar);
        }
        return chosen;
    };
    auto const same = [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); };
    Require(std::ranges::equal(choose(a), choose(b),
                               [&](auto const* x, auto const* y) {
                                   return x->name == y->name && x->numChannels == y->numChannels &&
                                          std::ranges::equal(x->values, y->values, same);
                               }),
            "primvars read back the same");
}

}  // namespace

void RequireSame(Scene const& a, Scene const& b, Kept const& kept) {
    Require(a.cage.numVertices == b.cage.numVertices && a.cage.faceSizes == b.cage.faceSizes &&
                a.cage.faceVertices == b.cage.faceVertices,
            "faces read back the same");
    Require(a.positions == b.positions, "positions read back the same");
    Require(ListCornerUVs(a) == ListCornerUVs(b), "texture coordinates read back the same");
    RequireSamePrimvars(a, b, !kept.allPrimvars);
    if (kept.tags) {
        RequireSameTags(a.cage, b.cage);
        Require(ListSharedUVs(a) == ListSharedUVs(b), "texture seams read back the same");
    }
    for (size_t kind = 0; kept.groups && kind < a.groups.size(); ++kind) {
        Require(ListGroupOfFaces(a, kind) == ListGroupOfFaces(b, kind),
                "groups read back the same");
    }
}

void RequireRoundTrips(Scene const& scene) {
    for (bool const isObj : {true, false}) {
        std::string const path = isObj ? "again.obj" : "again.ply";
        Scene const again = MustSucceed("what was read can be written and read again", [&] {
            return engine::ParseMesh(path,
                                     engine::FormatMesh(path, scene, Precision::Double).bytes);
        });
        RequireSame(scene, again, isObj ? kKeptByObj : kKeptByPly);
    }
}

}  // namespace limn::fuzz
