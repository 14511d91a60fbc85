// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/mesh_info.h"

#include <algorithm>

#include "engine/scene/parity_sets.h"

namespace limn::engine {

using Level = Far::TopologyLevel;

namespace {

/// Sizes, components and valences.
void CountVertices(Level const& level, MeshInfo& info) {
    ParitySets components(level.GetNumVertices());
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        auto const vertices = level.GetFaceVertices(face);
        ++info.facesBySize[vertices.size()];
        for (Index vertex : vertices) components.Join(vertices[0], vertex, 0);
    }
    Index numUsed = 0;
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (level.GetVertexFaces(vertex).size() == 0) continue;
        ++numUsed;
        info.components += components.Find(vertex).first == vertex;
        int const valence = level.GetVertexEdges(vertex).size();
        info.minValence = info.maxValence == 0 ? valence : std::min(info.minValence, valence);
        info.maxValence = std::max(info.maxValence, valence);
    }
    info.eulerCharacteristic = numUsed - level.GetNumEdges() + level.GetNumFaces();
}

int CountBoundaryLoops(Level const& level) {
    ParitySets loops(level.GetNumEdges());
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (level.GetVertexFaces(vertex).size() == 0) continue;
        Index previous = -1;
        for (Index edge : level.GetVertexEdges(vertex)) {
            if (!level.IsEdgeBoundary(edge)) continue;
            if (previous >= 0) loops.Join(previous, edge, 0);
            previous = edge;
        }
    }
    int count = 0;
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge)
        count += level.IsEdgeBoundary(edge) && loops.Find(edge).first == edge;
    return count;
}

bool IsOrientedManifold(std::vector<Defect> const& defects) {
    return std::none_of(defects.begin(), defects.end(), [](Defect const& defect) {
        return defect.kind.starts_with("non_manifold") || defect.kind == "not_orientable" ||
               defect.kind == "repeated_corner";
    });
}

}  // namespace

MeshInfo DescribeMesh(Model const& model) {
    Level const& level = model.GetLevel();
    auto const& cage = model.GetCage();
    MeshInfo info;
    info.vertices = level.GetNumVertices();
    info.edges = level.GetNumEdges();
    info.faces = level.GetNumFaces();
    info.creases = cage.creaseSharpness.size();
    info.corners = cage.cornerSharpness.size();
    info.holes = cage.holes.size();
    info.groups = model.ListGroups();
    info.defects = FindDefects(model);
    CountVertices(level, info);
    info.boundaryLoops = CountBoundaryLoops(level);
    if (IsOrientedManifold(info.defects))
        info.genus = (2 * info.components - info.eulerCharacteristic - info.boundaryLoops) / 2;
    info.uv = DescribeUVs(model);
    return info;
}

}  // namespace limn::engine
