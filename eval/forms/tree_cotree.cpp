// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/tree_cotree.h"

#include <numeric>

#include "far_ext/forms/form_operators.h"

namespace limn::eval {

namespace {

/// Disjoint sets, to grow a spanning tree.
class Sets {
public:
    explicit Sets(Index count) : _parents(count) { std::iota(_parents.begin(), _parents.end(), 0); }

    Index Find(Index i) {
        while (_parents[i] != i) i = _parents[i] = _parents[_parents[i]];
        return i;
    }

    /// False if the two were one already.
    bool Join(Index a, Index b) {
        a = Find(a);
        b = Find(b);
        if (a == b) return false;
        _parents[b] = a;
        return true;
    }

private:
    std::vector<Index> _parents;
};

enum class Role : char { None, Tree, Cotree, Generator };

/// Faces in the order in which the dual tree reaches them, each with the edge to its parent.
struct DualTree {
    std::vector<Index> order, parentEdge;  // parentEdge per face: -1 at a root
};

DualTree GrowDualTree(Far::TopologyLevel const& level, std::vector<Role>& roles, bool isRelative) {
    DualTree tree;
    tree.parentEdge.assign(level.GetNumFaces(), -1);
    std::vector<char> isReached(tree.parentEdge.size(), 0);
    auto const reach = [&](Index face, Index edge) {
        isReached[face] = 1;
        tree.parentEdge[face] = edge;
        tree.order.push_back(face);
        if (edge >= 0) roles[edge] = Role::Cotree;
    };
    size_t next = 0;
    auto const spread = [&] {
        for (; next < tree.order.size(); ++next) {
            for (Index edge : level.GetFaceEdges(tree.order[next])) {
                auto const faces = level.GetEdgeFaces(edge);
                if (roles[edge] != Role::None || faces.size() != 2) continue;
                Index const other = faces[0] == tree.order[next] ? faces[1] : faces[0];
                if (!isReached[other]) reach(other, edge);
            }
        }
    };
    // An open component hangs on its outside, which asks nothing of a form.
    for (Index edge = 0; !isRelative && edge < level.GetNumEdges(); ++edge) {
        auto const faces = level.GetEdgeFaces(edge);
        if (roles[edge] != Role::None || faces.size() != 1 || isReached[faces[0]]) continue;
        reach(faces[0], edge);
        spread();
    }
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        if (!isReached[face]) reach(face, -1);
        spread();
    }
    return tree;
}

}  // namespace

std::vector<std::vector<double>> FindClosedForms(Far::TopologyLevel const& level, bool isRelative) {
    std::vector<Role> roles(level.GetNumEdges(), Role::None);
    Sets sets(level.GetNumVertices());
    auto const isBoundary = [&](Index edge) { return level.GetEdgeFaces(edge).size() == 1; };
    for (Index edge = 0; isRelative && edge < level.GetNumEdges(); ++edge) {
        if (!isBoundary(edge)) continue;  // all 0, so that no value may go round them
        sets.Join(level.GetEdgeVertices(edge)[0], level.GetEdgeVertices(edge)[1]);
        roles[edge] = Role::Tree;
    }
    if (isRelative) {  // the loops of a component are one point
        std::vector<Index> first(level.GetNumVertices(), -1);
        Sets components(level.GetNumVertices());
        for (Index edge = 0; edge < level.GetNumEdges(); ++edge)
            components.Join(level.GetEdgeVertices(edge)[0], level.GetEdgeVertices(edge)[1]);
        for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
            if (!isBoundary(edge)) continue;
            Index const vertex = level.GetEdgeVertices(edge)[0];
            Index& known = first[components.Find(vertex)];
            if (known < 0) known = vertex;
            sets.Join(known, vertex);
        }
    }
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        if (level.GetEdgeFaces(edge).size() == 0 || roles[edge] != Role::None) continue;
        if (sets.Join(level.GetEdgeVertices(edge)[0], level.GetEdgeVertices(edge)[1]))
            roles[edge] = Role::Tree;
    }
    DualTree const dual = GrowDualTree(level, roles, isRelative);

    std::vector<std::vector<double>> forms;
    for (Index generator = 0; generator < level.GetNumEdges(); ++generator) {
        if (roles[generator] != Role::None || level.GetEdgeFaces(generator).size() == 0) continue;
        std::vector<double> form(roles.size(), 0.0);
        form[generator] = 1.0;
        // From the leaves: a face's sides but the one to its parent are known, and with it add up
        // to 0.
        for (auto face = dual.order.rbegin(); face != dual.order.rend(); ++face) {
            Index const open = dual.parentEdge[*face];
            if (open < 0) continue;
            double sum = 0.0, sign = 1.0;
            for (int j = 0; j < level.GetFaceEdges(*face).size(); ++j) {
                auto const side = far_ext::GetFaceSide(level, *face, j);
                if (side.edge == open)
                    sign = side.sign;
                else
                    sum += side.sign * form[side.edge];
            }
            form[open] = -sign * sum;
        }
        forms.push_back(std::move(form));
    }
    return forms;
}

}  // namespace limn::eval
