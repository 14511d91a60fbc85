// SPDX-License-Identifier: Apache-2.0
#include "support/triangle_flipper.h"

#include <algorithm>

#include "far_ext/topology/refiner.h"

namespace limn::test {

TriangleFlipper::TriangleFlipper(engine::Scene& scene)
    : _v(scene.cage.faceVertices), _valence(static_cast<size_t>(scene.cage.numVertices), 0) {
    auto const refiner = far_ext::CreateRefiner(scene.cage);
    auto const level = refiner->GetLevel(0);
    _across.assign(_v.size(), -1);
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const faces = level.GetEdgeFaces(edge);
        auto const places = level.GetEdgeFaceLocalIndices(edge);
        if (faces.size() == 2) Meet(3 * faces[0] + places[0], 3 * faces[1] + places[1]);
    }
    for (Index vertex : _v) ++ValenceOf(vertex);
}

std::array<Index, 4> TriangleFlipper::GetQuad(int e) const {
    return {From(e), From(Next(e)), From(Next(Next(e))), From(Next(Next(GetAcross(e))))};
}

bool TriangleFlipper::Flip(int e) {
    auto const [a, b, c, d] = GetQuad(e);
    int const other = GetAcross(e), f = e / 3 * 3, g = other / 3 * 3;
    if (ValenceOf(a) <= 3 || ValenceOf(b) <= 3 || c == d || AreJoined(Next(Next(e)), d))
        return false;
    int const bc = GetAcross(Next(e)), ca = GetAcross(Next(Next(e))), ad = GetAcross(Next(other)),
              db = GetAcross(Next(Next(other)));
    std::ranges::copy(std::array{c, a, d}, _v.begin() + f);
    std::ranges::copy(std::array{d, b, c}, _v.begin() + g);
    Meet(f, ca);
    Meet(f + 1, ad);
    Meet(f + 2, g + 2);
    Meet(g, db);
    Meet(g + 1, bc);
    --ValenceOf(a);
    --ValenceOf(b);
    ++ValenceOf(c);
    ++ValenceOf(d);
    return true;
}

void TriangleFlipper::Meet(int e, int other) {
    _across[static_cast<size_t>(e)] = other;
    if (other >= 0) _across[static_cast<size_t>(other)] = e;
}

/// Whether the vertex that edge `start` leaves has `d` as a neighbour, as far as the faces round it
/// go in one direction.
bool TriangleFlipper::AreJoined(int start, Index d) const {
    int e = start;
    do {
        if (From(Next(e)) == d) return true;
        int const across = GetAcross(e);
        if (across < 0) return false;
        e = Next(across);
    } while (e != start);
    return false;
}

}  // namespace limn::test
