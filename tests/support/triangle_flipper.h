// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "engine/scene/scene.h"

namespace limn::test {

/// Triangles with what lies across each edge, for flipping. Edge k of face f is number 3 f + k and
/// runs from the face's corner k.
class TriangleFlipper {
public:
    /// \param scene  triangles, manifold and wound one way; kept by reference and changed
    explicit TriangleFlipper(engine::Scene& scene);

    int GetNumEdges() const { return static_cast<int>(_v.size()); }

    /// The same edge seen from the other side; -1 at a boundary.
    int GetAcross(int e) const { return _across[static_cast<size_t>(e)]; }

    /// The ends of an edge that is no boundary, then the corner opposite to it in its own face,
    /// then that on the other side.
    std::array<Index, 4> GetQuad(int e) const;

    /// Joins what is opposite instead, unless that leaves a vertex with two faces or joins what is
    /// joined already. The sides of the quad are then the first two edges of either face.
    bool Flip(int e);

private:
    static int Next(int e) { return e % 3 == 2 ? e - 2 : e + 1; }
    Index From(int e) const { return _v[static_cast<size_t>(e)]; }
    int& ValenceOf(Index vertex) { return _valence[static_cast<size_t>(vertex)]; }
    void Meet(int e, int other);
    bool AreJoined(int start, Index d) const;

    std::vector<Index>& _v;
    std::vector<int> _across, _valence;
};

}  // namespace limn::test
