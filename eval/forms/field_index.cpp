// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/field_index.h"

#include "far_ext/forms/form_operators.h"

namespace limn::eval {

FieldIndices FindFieldIndices(Far::TopologyLevel const& level, std::span<double const> form) {
    FieldIndices result;
    std::vector<char> isPositive(form.size());
    for (size_t edge = 0; edge < form.size(); ++edge) isPositive[edge] = form[edge] >= 0.0;
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        for (int j = 0; j < level.GetFaceEdges(face).size(); ++j) {
            auto const side = far_ext::GetFaceSide(level, face, j);
            if (form[side.edge] == 0.0 && level.GetEdgeFaces(side.edge).size() == 1)
                isPositive[side.edge] = side.sign > 0.0;
        }
    }
    auto const isAlong = [&](far_ext::OrientedEdge side) {
        return (isPositive[side.edge] != 0) == (side.sign > 0.0);
    };
    auto const add = [&](bool isFace, Index element, double index) {
        if (index != 0.0) result.singularities.push_back({isFace, element, index});
        result.sum += index;
    };
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        auto const edges = level.GetVertexEdges(vertex);
        if (level.GetVertexFaces(vertex).size() == 0) continue;
        bool const isOpen = edges.size() != level.GetVertexFaces(vertex).size();
        int changes = 0;
        for (int i = 0; i < (isOpen ? edges.size() - 1 : edges.size()); ++i) {
            Index const next = edges[(i + 1) % edges.size()];
            bool const leaves = isAlong({edges[i], far_ext::GetSignFrom(level, edges[i], vertex)});
            changes += leaves != isAlong({next, far_ext::GetSignFrom(level, next, vertex)});
        }
        add(false, vertex, isOpen ? 0.5 * (1 - changes) : 1.0 - 0.5 * changes);
    }
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        int const size = level.GetFaceEdges(face).size();
        int changes = 0;
        for (int j = 0; j < size; ++j) {
            changes += isAlong(far_ext::GetFaceSide(level, face, j)) !=
                       isAlong(far_ext::GetFaceSide(level, face, (j + 1) % size));
        }
        add(true, face, 1.0 - 0.5 * changes);
    }
    return result;
}

}  // namespace limn::eval
