// SPDX-License-Identifier: Apache-2.0
#include "far_ext/differential/kobbelt.h"

#include <fmt/format.h>
#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/differential/simple_edges.h"
#include "far_ext/error.h"
#include "far_ext/rows/row_sum.h"
#include "far_ext/topology/boundary.h"

namespace limn::far_ext {

namespace {

using Level = Far::TopologyLevel;

class KobbeltRows {
public:
    KobbeltRows(Level const& coarse, double tension)
        : _coarse(coarse),
          _inner((8.0 + tension) / 16),
          _outer(-tension / 16),
          _turn(tension / (8.0 + tension)) {
        for (Index edge = 0; edge < coarse.GetNumEdges(); ++edge) AddEdge(edge);
    }

    SparseRows Build() const {
        SparseRows rows;
        RowSum sum;
        // OpenSubdiv's order of a Catmull-Clark refinement: vertices, faces, edges.
        for (Index vertex = 0; vertex < _coarse.GetNumVertices(); ++vertex) {
            sum.Clear();
            sum.Add(vertex, 1.0);
            sum.AppendTo(rows);
        }
        for (Index face = 0; face < _coarse.GetNumFaces(); ++face) {
            sum.Clear();
            for (int side = 0; side < 4; ++side) AddHalfStrip(face, side, sum);
            sum.AppendTo(rows);
        }
        for (Index edge = 0; edge < _coarse.GetNumEdges(); ++edge) {
            sum.Clear();
            sum.Add(_edgeRows, edge, 1.0);
            sum.AppendTo(rows);
        }
        return rows;
    }

private:
    void AddEdge(Index edge) {
        RowSum sum;
        for (Index end : _coarse.GetEdgeVertices(edge)) {
            sum.Add(end, _inner);
            AddBeyond(end, edge, sum);
        }
        sum.AppendTo(_edgeRows);
    }

    /// The outer point of F that follows an edge beyond one of its ends.
    void AddBeyond(Index end, Index edge, RowSum& sum) const {
        if (!_coarse.IsVertexBoundary(end)) return AddVirtualPoint(end, edge, sum);
        Index const start = GetOtherEnd(_coarse, edge, end);
        if (_coarse.IsEdgeBoundary(edge) && _coarse.GetVertexFaces(end).size() > 1) {
            auto const [a, b] = GetBoundaryNeighbours(_coarse, end);
            sum.Add(a == start ? b : a, _outer);
        } else {
            sum.Add(end, 2.0 * _outer);
            sum.Add(start, -_outer);
        }
    }

    /// With edge neighbours l_j round a vertex from the edge on, and the corners k_j of faces
    /// between l_j and l_j+1: (4/n) sum l_j - (l_-1 + l_0 + l_1) + t (k_-2 + k_-1 + k_0 + k_1)
    /// - (4t/n) sum k_j, which is l_2 at valence 4.
    void AddVirtualPoint(Index vertex, Index edge, RowSum& sum) const {
        auto const edges = _coarse.GetVertexEdges(vertex);  // in order round an inner vertex
        int const valence = edges.size(), start = edges.FindIndex(edge);
        auto const at = [&](int j) { return (start + j + 2 * valence) % valence; };
        double const share = 4.0 / valence;
        for (int j = 0; j < valence; ++j) {
            sum.Add(GetOtherEnd(_coarse, edges[j], vertex), _outer * share);
            sum.Add(FindFarCorner(vertex, j), -_outer * share * _turn);
        }
        for (int j : {-1, 0, 1}) sum.Add(GetOtherEnd(_coarse, edges[at(j)], vertex), -_outer);
        for (int j : {-2, -1, 0, 1}) sum.Add(FindFarCorner(vertex, at(j)), _outer * _turn);
    }

    /// Of face j at a vertex, which lies between its edges j and j + 1.
    Index FindFarCorner(Index vertex, int j) const {
        int const corner = _coarse.GetVertexFaceLocalIndices(vertex)[j];
        return _coarse.GetFaceVertices(_coarse.GetVertexFaces(vertex)[j])[(corner + 2) % 4];
    }

    /// What lies on one side of a face's middle in a strip of faces: its edge's point, and the next
    /// one beyond. Both strips have two sides, so that each counts half.
    void AddHalfStrip(Index face, int side, RowSum& sum) const {
        auto const edges = _coarse.GetFaceEdges(face);
        Index const near = edges[side], far = edges[(side + 2) % 4];
        sum.Add(_edgeRows, near, 0.5 * _inner);
        auto const faces = _coarse.GetEdgeFaces(near);
        auto const corners = _coarse.GetEdgeFaceLocalIndices(near);
        for (int i = 0; i < faces.size(); ++i) {
            if (faces[i] == face) continue;
            Index const beyond = _coarse.GetFaceEdges(faces[i])[(corners[i] + 2) % 4];
            return sum.Add(_edgeRows, beyond, 0.5 * _outer);
        }
        sum.Add(_edgeRows, near, _outer);
        sum.Add(_edgeRows, far, -0.5 * _outer);
    }

    Level const& _coarse;
    double const _inner, _outer;  // F's weights
    double const _turn;           // t; with it both strips give one point at an irregular vertex
    SparseRows _edgeRows;
};

/// Edges round a vertex are in order only where they make one ring.
void RequireManifoldVertices(Level const& level) {
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (!level.IsVertexNonManifold(vertex)) continue;
        throw Error(ErrorCode::BadMesh,
                    fmt::format("at vertex {} surfaces meet in a point; Kobbelt's rule needs one "
                                "ring of faces, so split it",
                                vertex));
    }
}

void RequireQuads(Level const& level) {
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        int const size = level.GetFaceVertices(face).size();
        if (size == 4) continue;
        throw Error(ErrorCode::Unsupported,
                    fmt::format("face {} has {} corners; Kobbelt's rule needs quads, which one "
                                "level of Catmull-Clark makes",
                                face, size));
    }
}

}  // namespace

SparseRows BuildKobbelt(Far::TopologyRefiner const& refiner, int level, double tension) {
    if (refiner.GetSchemeType() != Sdc::SCHEME_CATMARK)
        throw Error(ErrorCode::Unsupported, "Kobbelt's rule needs quads and the scheme catmark");
    Level const& coarse = refiner.GetLevel(level - 1);
    RequireQuads(coarse);
    RequireSimpleEdges(coarse, "Kobbelt's rule");
    RequireManifoldVertices(coarse);
    return KobbeltRows(coarse, tension).Build();
}

}  // namespace limn::far_ext
