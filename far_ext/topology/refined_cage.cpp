// SPDX-License-Identifier: Apache-2.0
#include "far_ext/topology/refined_cage.h"

namespace limn::far_ext {

namespace {

/// Tags as the last level has them. Boundaries are sharp by rule and need none, unless the rule
/// gives them no surface, where a tag tells which of them have one.
void CopyTags(Far::TopologyLevel const& level, Sdc::Options::VtxBoundaryInterpolation boundary,
              ControlMesh& cage) {
    bool const isBoundaryByRule = boundary != Sdc::Options::VTX_BOUNDARY_NONE;
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        float const sharpness = level.GetEdgeSharpness(edge);
        bool const isByRule =
            (isBoundaryByRule && level.IsEdgeBoundary(edge)) || level.IsEdgeNonManifold(edge);
        if (sharpness <= 0.0f || isByRule) continue;
        auto const ends = level.GetEdgeVertices(edge);
        cage.creaseVertexPairs.insert(cage.creaseVertexPairs.end(), {ends[0], ends[1]});
        cage.creaseSharpness.push_back(sharpness);
    }
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        float const sharpness = level.GetVertexSharpness(vertex);
        bool const isByRule = level.IsVertexNonManifold(vertex) ||
                              (boundary == Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER &&
                               level.IsVertexCorner(vertex));
        if (sharpness <= 0.0f || isByRule) continue;
        cage.cornerVertices.push_back(vertex);
        cage.cornerSharpness.push_back(sharpness);
    }
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        if (level.IsFaceHole(face)) cage.holes.push_back(face);
    }
}

}  // namespace

ControlMesh MakeRefinedCage(Far::TopologyRefiner const& refiner, ControlMesh const& base) {
    Far::TopologyLevel const last = refiner.GetLevel(refiner.GetMaxLevel());
    ControlMesh cage;
    cage.scheme = base.scheme;
    cage.options = base.options;
    cage.numVertices = last.GetNumVertices();
    cage.faceSizes.reserve(last.GetNumFaces());
    cage.faceVertices.reserve(last.GetNumFaceVertices());
    for (Index face = 0; face < last.GetNumFaces(); ++face) {
        auto const vertices = last.GetFaceVertices(face);
        cage.faceSizes.push_back(vertices.size());
        cage.faceVertices.insert(cage.faceVertices.end(), vertices.begin(), vertices.end());
    }
    for (int k = 0; k < refiner.GetNumFVarChannels(); ++k) {
        FVarChannel channel{last.GetNumFVarValues(k), {}};
        for (Index face = 0; face < last.GetNumFaces(); ++face) {
            auto const values = last.GetFaceFVarValues(face, k);
            channel.valueIndices.insert(channel.valueIndices.end(), values.begin(), values.end());
        }
        cage.fvarChannels.push_back(std::move(channel));
    }
    CopyTags(last, base.options.GetVtxBoundaryInterpolation(), cage);
    return cage;
}

std::vector<Index> FindBaseFaces(Far::TopologyRefiner const& refiner, int level) {
    std::vector<Index> base(refiner.GetLevel(level).GetNumFaces());
    for (Index face = 0; face < static_cast<Index>(base.size()); ++face) {
        Index at = face;
        for (int k = level; k > 0; --k) at = refiner.GetLevel(k).GetFaceParentFace(at);
        base[face] = at;
    }
    return base;
}

}  // namespace limn::far_ext
