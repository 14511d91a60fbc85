// SPDX-License-Identifier: Apache-2.0
#include "far_ext/differential/butterfly.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "far_ext/differential/simple_edges.h"
#include "far_ext/error.h"
#include "far_ext/topology/boundary.h"

namespace limn::far_ext {

namespace {

using Level = Far::TopologyLevel;

class ButterflyRows {
public:
    enum class AtIrregular { Ring, RegularMask };

    ButterflyRows(Level const& coarse, double tension, AtIrregular atIrregular)
        : _coarse(coarse), _tension(tension), _atIrregular(atIrregular) {}

    SparseRows Build() const {
        // OpenSubdiv's order of a Loop refinement: vertices first, then edges.
        SparseRows rows;
        WeightRow row;
        for (Index vertex = 0; vertex < _coarse.GetNumVertices(); ++vertex) {
            row.Clear();
            row.Add(vertex, 1.0);
            rows.AddRow(row);
        }
        for (Index edge = 0; edge < _coarse.GetNumEdges(); ++edge) rows.AddRow(Make(edge));
        return rows;
    }

private:
    /// The row of an edge's new vertex.
    WeightRow Make(Index edge) const {
        auto const ends = _coarse.GetEdgeVertices(edge);
        WeightRow row;
        if (_coarse.IsEdgeBoundary(edge)) {
            AddBoundaryRow(edge, row);
            return row;
        }
        bool const isFirst = IsIrregular(ends[0]), isSecond = IsIrregular(ends[1]);
        if (!isFirst && !isSecond) {
            AddRegularRow(edge, row);
            return row;
        }
        double const share = isFirst && isSecond ? 0.5 : 1.0;
        if (isFirst) AddIrregularEnd(ends[0], edge, share, row);
        if (isSecond) AddIrregularEnd(ends[1], edge, share, row);
        return row;
    }

    /// Vertices of a boundary count as regular.
    bool IsIrregular(Index vertex) const {
        return _atIrregular == AtIrregular::Ring && !_coarse.IsVertexBoundary(vertex) &&
               _coarse.GetVertexEdges(vertex).size() != 6;
    }

    void AddBoundaryRow(Index edge, WeightRow& row) const {
        for (Index end : _coarse.GetEdgeVertices(edge)) {
            row.Add(end, 0.5 + _tension);
            for (Index other : _coarse.GetVertexEdges(end)) {
                if (other != edge && _coarse.IsEdgeBoundary(other))
                    row.Add(GetOtherEnd(_coarse, other, end), -_tension);
            }
        }
    }

    void AddRegularRow(Index edge, WeightRow& row) const {
        for (Index end : _coarse.GetEdgeVertices(edge)) row.Add(end, 0.5);
        for (Index face : _coarse.GetEdgeFaces(edge)) {
            row.Add(FindOpposite(face, edge), 2.0 * _tension);
            for (Index side : _coarse.GetFaceEdges(face)) {
                if (side != edge) AddWing(face, side, -_tension, row);
            }
        }
    }

    /// The vertex across `side` from `face`, or across a boundary its reflection.
    void AddWing(Index face, Index side, double weight, WeightRow& row) const {
        for (Index other : _coarse.GetEdgeFaces(side)) {
            if (other != face) return row.Add(FindOpposite(other, side), weight);
        }
        for (Index end : _coarse.GetEdgeVertices(side)) row.Add(end, weight);
        row.Add(FindOpposite(face, side), -weight);
    }

    void AddIrregularEnd(Index vertex, Index edge, double share, WeightRow& row) const {
        auto const edges = _coarse.GetVertexEdges(vertex);  // in order round an inner vertex
        int const valence = edges.size(), start = edges.FindIndex(edge);
        row.Add(vertex, 0.75 * share);
        for (int j = 0; j < valence; ++j) {
            Index const neighbour = GetOtherEnd(_coarse, edges[(start + j) % valence], vertex);
            row.Add(neighbour, share * RingWeight(valence, j));
        }
    }

    static double RingWeight(int valence, int j) {
        constexpr double kThree[] = {5.0 / 12, -1.0 / 12, -1.0 / 12},
                         kFour[] = {3.0 / 8, 0.0, -1.0 / 8, 0.0};
        if (valence == 3) return kThree[j];
        if (valence == 4) return kFour[j];
        double const angle = 2.0 * std::numbers::pi * j / valence;
        return (0.25 + std::cos(angle) + 0.5 * std::cos(2.0 * angle)) / valence;
    }

    Index FindOpposite(Index face, Index edge) const {
        auto const ends = _coarse.GetEdgeVertices(edge);
        for (Index vertex : _coarse.GetFaceVertices(face)) {
            if (vertex != ends[0] && vertex != ends[1]) return vertex;
        }
        throw Error(ErrorCode::BadMesh,
                    fmt::format("face {} repeats a vertex; a triangle has three", face));
    }

    Level const& _coarse;
    double const _tension;  // w: 2w on opposite vertices, -w on wings
    AtIrregular const _atIrregular;
};

SparseRows BuildRows(Far::TopologyRefiner const& refiner, int level, double tension,
                     ButterflyRows::AtIrregular atIrregular) {
    if (refiner.GetSchemeType() != Sdc::SCHEME_LOOP) {
        throw Error(ErrorCode::Unsupported,
                    "the Butterfly rule needs triangles and the scheme loop");
    }
    Level const& coarse = refiner.GetLevel(level - 1);
    RequireSimpleEdges(coarse, "Butterfly");
    return ButterflyRows(coarse, tension, atIrregular).Build();
}

}  // namespace

SparseRows BuildButterfly(Far::TopologyRefiner const& refiner, int level) {
    return BuildRows(refiner, level, 1.0 / 16, ButterflyRows::AtIrregular::Ring);
}

SparseRows BuildOriginalButterfly(Far::TopologyRefiner const& refiner, int level, double tension) {
    return BuildRows(refiner, level, tension, ButterflyRows::AtIrregular::RegularMask);
}

}  // namespace limn::far_ext
