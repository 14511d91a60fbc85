// SPDX-License-Identifier: Apache-2.0
#include "far_ext/forms/form_stencils.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "far_ext/error.h"
#include "far_ext/forms/find_wheel.h"
#include "far_ext/forms/form_operators.h"
#include "far_ext/rows/row_writer.h"
#include "far_ext/rows/sparse_matrix.h"

namespace limn::far_ext {

namespace {

/// Everything in a wheel that its rows depend on.
std::vector<double> MakeKey(Wheel const& wheel) {
    std::vector<double> key{wheel.isInterior ? 1.0 : 0.0, wheel.faceWeight};
    key.insert(key.end(), wheel.sizes.begin(), wheel.sizes.end());
    key.insert(key.end(), wheel.faceShares.begin(), wheel.faceShares.end());
    key.insert(key.end(), wheel.edgeWeights.begin(), wheel.edgeWeights.end());
    for (Wheel::Rule const* rule : {&wheel.parent, &wheel.child}) {
        key.insert(key.end(), {rule->share, rule->isCrease ? 1.0 : 0.0});
        key.insert(key.end(), rule->isSharp.begin(), rule->isSharp.end());
    }
    return key;
}

/// What is read of a level to make the next one's stencils. Rows are measured first and written in
/// place; wheels that look alike share their solution.
class FormStencilBuilder {
public:
    FormStencilBuilder(Far::TopologyRefiner const& refiner, int level)
        : _refiner(refiner),
          _scheme(refiner.GetSchemeType()),
          _coarse(refiner.GetLevel(level - 1)),
          _fine(refiner.GetLevel(level)),
          _s1(_fine.GetNumEdges()),
          _s2(_fine.GetNumFaces()),
          _seen(_coarse.GetNumEdges(), -1) {}

    FormStencils Build() {
        bool const isLoop = _scheme == Sdc::SCHEME_LOOP;
        _mu.assign(isLoop ? _coarse.GetNumFaces() : 0, {0.25, 0.25, 0.25});
        _rowsOfVertex.assign(_coarse.GetNumVertices(), nullptr);
        for (Index vertex = 0; vertex < _coarse.GetNumVertices(); ++vertex) {
            if (_coarse.GetVertexFaces(vertex).size() > 0) MeasureVertex(vertex);
        }
        for (Index face = 0; face < _coarse.GetNumFaces(); ++face) {
            if (isLoop)
                MeasureCentralChild(face);
            else
                MeasureEdgesToCentre(face);
        }
        _s1.Allocate();
        _s2.Allocate();
        for (Index vertex = 0; vertex < _coarse.GetNumVertices(); ++vertex) {
            if (_rowsOfVertex[vertex]) WriteVertex(vertex, *_rowsOfVertex[vertex]);
        }
        for (Index face = 0; face < _coarse.GetNumFaces(); ++face) {
            if (isLoop)
                WriteCentralChild(face);
            else
                WriteEdgesToCentre(face);
        }
        return {_s1.Get(), _s2.Get()};
    }

private:
    WheelRows const& GetRows(Index vertex);
    bool IsSmoothAndRegular(Index vertex) const;
    double FindShare(Index edge) const { return FindFaceShare(_refiner, _coarse, &_fine, edge); }
    Index GetFineSpoke(Index vertex, Index edge) const {
        return _coarse.GetEdgeChildEdges(edge)[_coarse.GetEdgeVertices(edge)[0] == vertex ? 0 : 1];
    }
    Index GetNeighbour(Index face, Index edge) const {
        auto const faces = _coarse.GetEdgeFaces(edge);
        return faces[0] == face ? faces[1] : faces[0];
    }

    void MeasureVertex(Index vertex);
    void WriteVertex(Index vertex, WheelRows const& rows);
    void MeasureCentralChild(Index face);
    void WriteCentralChild(Index face);
    void MeasureEdgesToCentre(Index face);
    void WriteEdgesToCentre(Index face);

    /// Writes a row over the wheel of which _wheelEdges tells the edges.
    void WriteEdgeRow(WheelRows::Row const& row, Index from, Index to, Index fineEdge,
                      bool isRepeated) {
        double const sign = from < to ? 1.0 : -1.0;
        _s1.Start(fineEdge);
        for (auto const& [local, weight] : row) {
            OrientedEdge const& edge = _wheelEdges[local];
            _s1.Add(edge.edge, sign * edge.sign * weight);
        }
        if (isRepeated) _s1.MarkRepeated(fineEdge);
    }

    Far::TopologyRefiner const& _refiner;
    Sdc::SchemeType _scheme;
    Far::TopologyLevel _coarse, _fine;
    RowWriter _s1, _s2;
    std::vector<OrientedEdge> _wheelEdges;
    std::vector<std::unique_ptr<WheelRows>> _smoothRows;  // by valence
    std::map<std::vector<double>, WheelRows> _otherRows;  // by MakeKey
    std::vector<WheelRows const*> _rowsOfVertex;
    std::vector<std::array<double, 3>> _mu;  // Loop: per face and corner
    std::vector<Index> _seen;  // per edge: the vertex whose wheel it was last found in
};

/// Its wheel depends on its valence alone.
bool FormStencilBuilder::IsSmoothAndRegular(Index vertex) const {
    int const size = _scheme == Sdc::SCHEME_LOOP ? 3 : 4;
    auto const faces = _coarse.GetVertexFaces(vertex);
    return IsSmoothInterior(_coarse, vertex) &&
           std::all_of(faces.begin(), faces.end(),
                       [&](Index face) { return _coarse.GetFaceVertices(face).size() == size; });
}

WheelRows const& FormStencilBuilder::GetRows(Index vertex) {
    size_t const k = _coarse.GetVertexFaces(vertex).size();
    if (!IsSmoothAndRegular(vertex)) {
        Wheel const wheel = FindWheel(_refiner, _coarse, &_fine, vertex);
        auto const [found, isNew] = _otherRows.try_emplace(MakeKey(wheel));
        if (isNew) found->second = MakeWheelRows(_scheme, wheel);
        return found->second;
    }
    if (_smoothRows.size() <= k) _smoothRows.resize(k + 1);
    auto& known = _smoothRows[k];
    if (!known)
        known = std::make_unique<WheelRows>(
            MakeWheelRows(_scheme, MakeSmoothWheel(_scheme, static_cast<int>(k))));
    return *known;
}

void FormStencilBuilder::MeasureVertex(Index vertex) {
    auto const faces = _coarse.GetVertexFaces(vertex);
    auto const corners = _coarse.GetVertexFaceLocalIndices(vertex);
    auto const edges = _coarse.GetVertexEdges(vertex);
    if (faces.size() > 4096) {
        throw Error(ErrorCode::TooLarge,
                    fmt::format("vertex {} has {} faces; stencils of forms go up to 4096", vertex,
                                faces.size()));
    }
    WheelRows const& rows = GetRows(vertex);
    _rowsOfVertex[vertex] = &rows;
    for (int i = 0; i < edges.size(); ++i)
        _s1.SetSize(GetFineSpoke(vertex, edges[i]), rows.even[i].size());
    for (int i = 0; i < faces.size(); ++i) {
        _s2.SetSize(_coarse.GetFaceChildFaces(faces[i])[corners[i]], rows.children[i].size());
        if (rows.odd.empty()) continue;
        _mu[faces[i]][corners[i]] = rows.mu[i];
        _s1.SetSize(_coarse.GetFaceChildEdges(faces[i])[corners[i]], rows.odd[i].size());
    }
}

void FormStencilBuilder::WriteVertex(Index vertex, WheelRows const& rows) {
    auto const faces = _coarse.GetVertexFaces(vertex);
    auto const corners = _coarse.GetVertexFaceLocalIndices(vertex);
    auto const edges = _coarse.GetVertexEdges(vertex);
    bool isRepeated = false;
    auto const add = [&](OrientedEdge edge) {
        isRepeated |= _seen[edge.edge] == vertex;
        _seen[edge.edge] = vertex;
        _wheelEdges.push_back(edge);
    };
    _wheelEdges.clear();
    for (Index edge : edges) add({edge, GetSignFrom(_coarse, edge, vertex)});
    for (int i = 0; i < faces.size(); ++i) {
        int const size = _coarse.GetFaceVertices(faces[i]).size();
        for (int m = 1; m < size - 1; ++m)
            add(GetFaceSide(_coarse, faces[i], (corners[i] + m) % size));
    }

    Index const child = _coarse.GetVertexChildVertex(vertex);
    for (int i = 0; i < edges.size(); ++i) {
        WriteEdgeRow(rows.even[i], child, _coarse.GetEdgeChildVertex(edges[i]),
                     GetFineSpoke(vertex, edges[i]), isRepeated);
    }
    for (int i = 0; i < faces.size(); ++i) {
        Index const fineFace = _coarse.GetFaceChildFaces(faces[i])[corners[i]];
        _s2.Start(fineFace);
        for (auto const& [local, weight] : rows.children[i]) _s2.Add(faces[local], weight);
        if (rows.odd.empty()) continue;
        WriteEdgeRow(rows.odd[i], _coarse.GetEdgeChildVertex(edges[i]),
                     _coarse.GetEdgeChildVertex(edges[(i + 1) % edges.size()]),
                     _coarse.GetFaceChildEdges(faces[i])[corners[i]], isRepeated);
    }
}

void FormStencilBuilder::MeasureCentralChild(Index face) {
    size_t size = 1;
    for (Index edge : _coarse.GetFaceEdges(face)) size += FindShare(edge) != 0.0;
    _s2.SetSize(_coarse.GetFaceChildFaces(face)[3], size);
}

/// [Forms 3.3]: (1 - sum p) f + sum p g - sum of the corners' y, with the y written out.
void FormStencilBuilder::WriteCentralChild(Index face) {
    Index const fineFace = _coarse.GetFaceChildFaces(face)[3];
    auto const edges = _coarse.GetFaceEdges(face);
    double own = 1.0;
    _s2.Start(fineFace);
    bool isRepeated = false;
    for (int j = 0; j < 3; ++j) {
        double const p = FindShare(edges[j]);
        own -= 0.5 * p + _mu[face][j];
        if (p == 0.0) continue;
        Index const neighbour = GetNeighbour(face, edges[j]);
        _s2.Add(neighbour, 0.5 * p);
        isRepeated |= neighbour == face;
        for (int i = 0; i < j; ++i)
            isRepeated |= FindShare(edges[i]) != 0.0 && GetNeighbour(face, edges[i]) == neighbour;
    }
    _s2.Add(face, own);
    if (isRepeated) _s2.MarkRepeated(fineFace);
}

void FormStencilBuilder::MeasureEdgesToCentre(Index face) {
    auto const edges = _coarse.GetFaceEdges(face);
    // The side across has weight 0.
    auto const count = [](int size) -> size_t { return size % 2 == 0 ? size - 2 : size - 1; };
    for (int j = 0; j < edges.size(); ++j) {
        size_t size = count(edges.size());
        if (FindShare(edges[j]) != 0.0)
            size += count(_coarse.GetFaceVertices(GetNeighbour(face, edges[j])).size());
        _s1.SetSize(_coarse.GetFaceChildEdges(face)[j], size);
    }
}

/// [Forms 4], odd edges: from the middle of a side e to the centroid, (1 - q) F(e, f) - q F(e, g).
void FormStencilBuilder::WriteEdgesToCentre(Index face) {
    Index const centre = _coarse.GetFaceChildVertex(face);
    auto const edges = _coarse.GetFaceEdges(face);
    for (int j = 0; j < edges.size(); ++j) {
        Index const fineEdge = _coarse.GetFaceChildEdges(face)[j];
        double const q = FindShare(edges[j]);
        double const sign = _coarse.GetEdgeChildVertex(edges[j]) < centre ? 1.0 : -1.0;
        _s1.Start(fineEdge);
        auto const addPath = [&](Index f, int from, double weight) {
            int const size = _coarse.GetFaceVertices(f).size();
            for (int m = 1; m < size; ++m) {
                if (2 * m == size) continue;
                OrientedEdge const side = GetFaceSide(_coarse, f, (from + m) % size);
                _s1.Add(side.edge,
                        sign * weight * side.sign * (0.5 - static_cast<double>(m) / size));
            }
        };
        addPath(face, j, 1.0 - q);
        if (q == 0.0) continue;
        auto const faces = _coarse.GetEdgeFaces(edges[j]);
        auto const places = _coarse.GetEdgeFaceLocalIndices(edges[j]);
        int const other = faces[0] == face && places[0] == j ? 1 : 0;
        addPath(faces[other], places[other], -q);
        // Two faces may share more sides than this one.
        for (Index edge : _coarse.GetFaceEdges(faces[other])) {
            if (std::count(edges.begin(), edges.end(), edge) + (faces[other] == face) >
                (edge == edges[j])) {
                _s1.MarkRepeated(fineEdge);
                break;
            }
        }
    }
}

SparseRows Multiply(SparseRows const& a, SparseRows const& b, Index numColumns) {
    Eigen::SparseMatrix<double, Eigen::RowMajor, int> product =
        AsMatrix(a, b.GetNumRows()) * AsMatrix(b, numColumns);
    product.makeCompressed();
    SparseRows result;
    result.offsets.assign(product.outerIndexPtr(), product.outerIndexPtr() + product.rows() + 1);
    result.indices.assign(product.innerIndexPtr(), product.innerIndexPtr() + product.nonZeros());
    result.weights.assign(product.valuePtr(), product.valuePtr() + product.nonZeros());
    return result;
}

}  // namespace

FormStencils BuildFormStencils(Far::TopologyRefiner const& refiner, int level) {
    return FormStencilBuilder(refiner, level).Build();
}

FormStencils ComposeFormStencils(Far::TopologyRefiner const& refiner, int level) {
    FormStencils total = BuildFormStencils(refiner, 1);
    auto const base = refiner.GetLevel(0);
    for (int next = 2; next <= level; ++next) {
        FormStencils const step = BuildFormStencils(refiner, next);
        total.s1 = Multiply(step.s1, total.s1, base.GetNumEdges());
        total.s2 = Multiply(step.s2, total.s2, base.GetNumFaces());
    }
    return total;
}

StencilRows MakeStencilRows(SparseRows const& rows, Index numColumns) {
    StencilRows result(numColumns, 1);
    for (int row = 0; row < rows.GetNumRows(); ++row) {
        for (int k = rows.offsets[row]; k < rows.offsets[row + 1]; ++k) {
            float const weight = static_cast<float>(rows.weights[k]);
            result.AddEntry(rows.indices[k], &weight);
        }
        result.EndRow();
    }
    return result;
}

}  // namespace limn::far_ext
