// SPDX-License-Identifier: Apache-2.0
#include "far_ext/topology/face_components.h"

#include <map>
#include <numeric>

namespace limn::far_ext {

FaceComponents FaceComponents::Find(Far::TopologyLevel const& level) {
    std::vector<Index> parent(level.GetNumVertices());
    std::iota(parent.begin(), parent.end(), 0);
    auto const root = [&](Index v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        auto const vertices = level.GetFaceVertices(face);
        for (Index v : vertices) parent[root(v)] = root(vertices[0]);
    }
    FaceComponents components;
    std::map<Index, int> numbers;
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        Index const r = root(level.GetFaceVertices(face)[0]);
        components.ofFace.push_back(
            numbers.try_emplace(r, static_cast<int>(numbers.size())).first->second);
    }
    components.count = static_cast<int>(numbers.size());
    return components;
}

std::vector<int> FaceComponents::FindEulerCharacteristics(Far::TopologyLevel const& level) const {
    std::vector<int> euler(count, 0);
    for (int component : ofFace) ++euler[component];
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (level.GetVertexFaces(vertex).size()) ++euler[ofFace[level.GetVertexFaces(vertex)[0]]];
    }
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge)
        --euler[ofFace[level.GetEdgeFaces(edge)[0]]];
    return euler;
}

}  // namespace limn::far_ext
