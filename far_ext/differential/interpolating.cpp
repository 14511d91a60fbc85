// SPDX-License-Identifier: Apache-2.0
#include "far_ext/differential/interpolating.h"

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/rows/row_sum.h"

namespace limn::far_ext {

namespace {

using Level = Far::TopologyLevel;

class InterpolatingRows {
public:
    InterpolatingRows(Level const& coarse, SparseRows const& approximating)
        : _coarse(coarse), _approximating(approximating) {}

    void AddVertex(Index vertex) {
        _sum.Clear();
        _sum.Add(vertex, 1.0);
        _sum.AppendTo(_rows);
    }

    /// The row of a new point between vertices.
    void AddNew(Index child, Far::ConstIndexArray vertices) {
        _sum.Clear();
        _sum.Add(_approximating, child, 1.0);
        double const share = 1.0 / vertices.size();
        for (Index vertex : vertices) {
            _sum.Add(_approximating, _coarse.GetVertexChildVertex(vertex), -share);
            _sum.Add(vertex, share);
        }
        _sum.AppendTo(_rows);
    }

    SparseRows Take() { return std::move(_rows); }

private:
    Level const& _coarse;
    SparseRows const& _approximating;
    RowSum _sum;
    SparseRows _rows;
};

}  // namespace

SparseRows DeduceInterpolatingRows(Far::TopologyRefiner const& refiner, int level,
                                   SparseRows const& approximating) {
    Level const& coarse = refiner.GetLevel(level - 1);
    InterpolatingRows rows(coarse, approximating);
    // OpenSubdiv's order: children of vertices, of faces where the scheme has them, of edges.
    for (Index vertex = 0; vertex < coarse.GetNumVertices(); ++vertex) rows.AddVertex(vertex);
    if (refiner.GetSchemeType() != Sdc::SCHEME_LOOP) {
        for (Index face = 0; face < coarse.GetNumFaces(); ++face)
            rows.AddNew(coarse.GetFaceChildVertex(face), coarse.GetFaceVertices(face));
    }
    for (Index edge = 0; edge < coarse.GetNumEdges(); ++edge)
        rows.AddNew(coarse.GetEdgeChildVertex(edge), coarse.GetEdgeVertices(edge));
    return rows.Take();
}

}  // namespace limn::far_ext
