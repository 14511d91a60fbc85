#include "far_ext/form_stencils.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/SparseCore>
#include <fmt/format.h>
#include <opensubdiv/sdc/crease.h>

#include "far_ext/error.h"
#include "far_ext/form_operators.h"

namespace limn::far_ext {

namespace {

using Rule = Sdc::Crease::Rule;

bool IsSmooth(Rule rule) { return rule == Sdc::Crease::RULE_SMOOTH || rule == Sdc::Crease::RULE_DART; }

/// Rows that come in any order, put in order at the end.
class RowCollector {
public:
    explicit RowCollector(Index numRows) : _places(static_cast<size_t>(numRows)) {}

    /// Adds an entry to the row that EndRow will close.
    void Add(Index column, double weight) { _entries.push_back({column, weight}); }

    void EndRow(Index row) {
        MergeRepeated();
        _places[row] = {_begin, static_cast<int>(_entries.size() - _begin)};
        _begin = _entries.size();
    }

    SparseRows Get() const {
        if (_entries.size() > static_cast<size_t>(std::numeric_limits<int>::max())) {
            throw Error(ErrorCode::TooLarge, "the stencil tables of forms pass 2^31 entries; refine fewer levels");
        }
        SparseRows rows;
        rows.offsets.reserve(_places.size() + 1);
        rows.indices.resize(_entries.size());
        rows.weights.resize(_entries.size());
        size_t at = 0;
        for (auto const& [begin, size] : _places) {
            for (size_t k = begin; k < begin + static_cast<size_t>(size); ++k, ++at) {
                rows.indices[at] = _entries[k].column;
                rows.weights[at] = _entries[k].weight;
            }
            rows.offsets.push_back(static_cast<int>(at));
        }
        return rows;
    }

private:
    struct Entry {
        Index column;
        double weight;
    };
    struct Place {
        size_t begin = 0;
        int size = 0;
    };

    /// A side that two faces of a wheel share (valence 2, small closed meshes) has come twice.
    void MergeRepeated() {
        auto const begin = _entries.begin() + static_cast<std::ptrdiff_t>(_begin);
        std::sort(begin, _entries.end(), [](Entry const& a, Entry const& b) { return a.column < b.column; });
        auto last = begin;
        for (auto next = begin; next != _entries.end(); ++next) {
            if (next == begin) continue;
            if (next->column == last->column) last->weight += next->weight;
            else *++last = *next;
        }
        if (begin == _entries.end()) return;
        auto const end = std::remove_if(begin, last + 1, [](Entry const& entry) { return std::abs(entry.weight) < 1e-15; });
        _entries.erase(end, _entries.end());
    }

    std::vector<Entry> _entries;
    std::vector<Place> _places;
    size_t _begin = 0;
};

/// p or q: what an edge's rule gives to each side beyond its ends.
double FindFaceShare(Sdc::SchemeType scheme, Far::TopologyLevel const& level, Far::TopologyLevel const* next, Index edge) {
    double const smooth = scheme == Sdc::SCHEME_LOOP ? 0.125 : 0.25;
    float const sharpness = level.GetEdgeSharpness(edge);
    if (sharpness <= 0.0f) return smooth;
    if (!next || next->GetVertexRule(level.GetEdgeChildVertex(edge)) == Sdc::Crease::RULE_CREASE) return 0.0;
    return smooth * static_cast<double>(1.0f - sharpness);
}

/// \param next  the level after; without one sharpness stays
Wheel FindWheel(Far::TopologyRefiner const& refiner, Far::TopologyLevel const& level, Far::TopologyLevel const* next, Index vertex) {
    Sdc::SchemeType const scheme = refiner.GetSchemeType();
    Sdc::Crease const creasing(refiner.GetSchemeOptions());
    auto const faces = level.GetVertexFaces(vertex);
    auto const edges = level.GetVertexEdges(vertex);
    int const numSpokes = edges.size(), k = faces.size();
    Wheel wheel;
    wheel.isInterior = numSpokes == k;
    for (Index face : faces) wheel.sizes.push_back(level.GetFaceVertices(face).size());

    // Sharpness before and after, and the two rules between which OpenSubdiv blends.
    std::vector<float> before, after;
    for (Index edge : edges) {
        wheel.faceShares.push_back(FindFaceShare(scheme, level, next, edge));
        before.push_back(level.GetEdgeSharpness(edge));
        after.push_back(next ? next->GetEdgeSharpness(level.GetEdgeChildEdges(edge)[level.GetEdgeVertices(edge)[0] == vertex ? 0 : 1]) : before.back());
    }
    Rule const parent = level.GetVertexRule(vertex);
    Rule child = parent;
    double t = 1.0;
    if (next) {
        Index const childVertex = level.GetVertexChildVertex(vertex);
        child = next->GetVertexRule(childVertex);
        if (parent != child && !IsSmooth(parent)) {
            t = static_cast<double>(creasing.ComputeFractionalWeightAtVertex(level.GetVertexSharpness(vertex), next->GetVertexSharpness(childVertex),
                                                                             numSpokes, before.data(), after.data()));
        }
    }

    wheel.edgeWeights.assign(static_cast<size_t>(numSpokes), 0.0);
    double const square = static_cast<double>(numSpokes) * numSpokes;
    auto const add = [&](Wheel::Rule& target, Rule rule, std::vector<float> const& sharpness, double share) {
        target.share = share;
        target.isCrease = rule == Sdc::Crease::RULE_CREASE;
        for (float s : sharpness) target.isSharp.push_back(s > 0.0f);
        if (share == 0.0) return;
        if (IsSmooth(rule)) {
            for (double& a : wheel.edgeWeights) a += share * (scheme == Sdc::SCHEME_LOOP ? GetLoopWeight(k) : 1.0 / square);
            if (scheme == Sdc::SCHEME_CATMARK) wheel.faceWeight += share / square;
        } else if (target.isCrease) {
            int ends[2];
            creasing.GetSharpEdgePairOfCrease(sharpness.data(), numSpokes, ends);
            for (int end : ends) wheel.edgeWeights[static_cast<size_t>(end)] += share * 0.125;
        }
    };
    add(wheel.parent, parent, before, t);
    add(wheel.child, child, after, 1.0 - t);
    return wheel;
}

/// What is read of a level to make the next one's stencils.
class FormStencilBuilder {
public:
    FormStencilBuilder(Far::TopologyRefiner const& refiner, int level)
        : _refiner(refiner), _scheme(refiner.GetSchemeType()), _coarse(refiner.GetLevel(level - 1)), _fine(refiner.GetLevel(level)),
          _s1(_fine.GetNumEdges()), _s2(_fine.GetNumFaces()) {}

    FormStencils Build() {
        bool const isLoop = _scheme == Sdc::SCHEME_LOOP;
        _mu.assign(isLoop ? 3 * static_cast<size_t>(_coarse.GetNumFaces()) : 0, 0.25);
        for (Index vertex = 0; vertex < _coarse.GetNumVertices(); ++vertex) {
            if (_coarse.GetVertexFaces(vertex).size() > 0) AddVertex(vertex);
        }
        for (Index face = 0; face < _coarse.GetNumFaces(); ++face) {
            if (isLoop) AddCentralChild(face);
            else AddEdgesToCentre(face);
        }
        return {_s1.Get(), _s2.Get()};
    }

private:
    WheelRows const& GetRows(Index vertex);
    bool IsSmoothAndRegular(Index vertex) const;
    void AddVertex(Index vertex);
    void AddCentralChild(Index face);
    void AddEdgesToCentre(Index face);
    double FindShare(Index edge) const { return FindFaceShare(_scheme, _coarse, &_fine, edge); }

    /// Writes a row over the wheel of which _wheelEdges tells the edges.
    void EmitEdgeRow(WheelRows::Row const& row, Index from, Index to, Index fineEdge) {
        double const sign = from < to ? 1.0 : -1.0;
        for (auto const& [local, weight] : row) {
            OrientedEdge const& edge = _wheelEdges[static_cast<size_t>(local)];
            _s1.Add(edge.edge, sign * edge.sign * weight);
        }
        _s1.EndRow(fineEdge);
    }

    Far::TopologyRefiner const& _refiner;
    Sdc::SchemeType _scheme;
    Far::TopologyLevel _coarse, _fine;
    RowCollector _s1, _s2;
    std::vector<OrientedEdge> _wheelEdges;
    std::vector<std::optional<WheelRows>> _smoothRows;  // by valence
    WheelRows _rows;                                    // of the vertex at hand, where it is not among those
    std::vector<double> _mu;                            // Loop: per corner of the faces
};

bool FormStencilBuilder::IsSmoothAndRegular(Index vertex) const {
    if (_coarse.GetVertexRule(vertex) != Sdc::Crease::RULE_SMOOTH || _coarse.IsVertexBoundary(vertex)) return false;
    for (Index edge : _coarse.GetVertexEdges(vertex)) {
        if (_coarse.GetEdgeSharpness(edge) > 0.0f) return false;
    }
    int const size = _scheme == Sdc::SCHEME_LOOP ? 3 : 4;
    auto const faces = _coarse.GetVertexFaces(vertex);
    return std::all_of(faces.begin(), faces.end(), [&](Index face) { return _coarse.GetFaceVertices(face).size() == size; });
}

WheelRows const& FormStencilBuilder::GetRows(Index vertex) {
    size_t const k = static_cast<size_t>(_coarse.GetVertexFaces(vertex).size());
    if (!IsSmoothAndRegular(vertex)) return _rows = MakeWheelRows(_scheme, FindWheel(_refiner, _coarse, &_fine, vertex));
    if (_smoothRows.size() <= k) _smoothRows.resize(k + 1);
    auto& known = _smoothRows[k];
    if (!known) known = MakeWheelRows(_scheme, MakeSmoothWheel(_scheme, static_cast<int>(k)));
    return *known;
}

void FormStencilBuilder::AddVertex(Index vertex) {
    auto const faces = _coarse.GetVertexFaces(vertex);
    auto const corners = _coarse.GetVertexFaceLocalIndices(vertex);
    auto const edges = _coarse.GetVertexEdges(vertex);
    if (faces.size() > 4096) {
        throw Error(ErrorCode::TooLarge, fmt::format("vertex {} has {} faces; stencils of forms go up to 4096", vertex, faces.size()));
    }
    WheelRows const& rows = GetRows(vertex);

    _wheelEdges.clear();
    for (Index edge : edges) _wheelEdges.push_back({edge, GetSignFrom(_coarse, edge, vertex)});
    for (int i = 0; i < faces.size(); ++i) {
        int const size = _coarse.GetFaceVertices(faces[i]).size();
        for (int m = 1; m < size - 1; ++m) _wheelEdges.push_back(GetFaceSide(_coarse, faces[i], (corners[i] + m) % size));
    }

    Index const child = _coarse.GetVertexChildVertex(vertex);
    for (int i = 0; i < edges.size(); ++i) {
        Index const fineEdge = _coarse.GetEdgeChildEdges(edges[i])[_coarse.GetEdgeVertices(edges[i])[0] == vertex ? 0 : 1];
        EmitEdgeRow(rows.even[static_cast<size_t>(i)], child, _coarse.GetEdgeChildVertex(edges[i]), fineEdge);
    }
    for (int i = 0; i < faces.size(); ++i) {
        for (auto const& [local, weight] : rows.children[static_cast<size_t>(i)]) _s2.Add(faces[local], weight);
        _s2.EndRow(_coarse.GetFaceChildFaces(faces[i])[corners[i]]);
        if (rows.odd.empty()) continue;
        _mu[3 * static_cast<size_t>(faces[i]) + corners[i]] = rows.mu[static_cast<size_t>(i)];
        EmitEdgeRow(rows.odd[static_cast<size_t>(i)], _coarse.GetEdgeChildVertex(edges[i]),
                    _coarse.GetEdgeChildVertex(edges[(i + 1) % edges.size()]), _coarse.GetFaceChildEdges(faces[i])[corners[i]]);
    }
}

/// forms.md 3.3: (1 - sum p) f + sum p g - sum of the corners' y, with the y written out.
void FormStencilBuilder::AddCentralChild(Index face) {
    double own = 1.0;
    auto const edges = _coarse.GetFaceEdges(face);
    for (int j = 0; j < 3; ++j) {
        double const p = FindShare(edges[j]);
        own -= 0.5 * p + _mu[3 * static_cast<size_t>(face) + static_cast<size_t>(j)];
        if (p == 0.0) continue;
        auto const faces = _coarse.GetEdgeFaces(edges[j]);
        _s2.Add(faces[0] == face ? faces[1] : faces[0], 0.5 * p);
    }
    _s2.Add(face, own);
    _s2.EndRow(_coarse.GetFaceChildFaces(face)[3]);
}

/// forms.md 4, odd edges: from the middle of a side e to the centroid, (1 - q) F(e, f) - q F(e, g).
void FormStencilBuilder::AddEdgesToCentre(Index face) {
    Index const centre = _coarse.GetFaceChildVertex(face);
    auto const edges = _coarse.GetFaceEdges(face);
    for (int j = 0; j < edges.size(); ++j) {
        double const q = FindShare(edges[j]);
        double const sign = _coarse.GetEdgeChildVertex(edges[j]) < centre ? 1.0 : -1.0;
        auto const addPath = [&](Index f, int from, double weight) {
            int const size = _coarse.GetFaceVertices(f).size();
            for (int m = 1; m < size; ++m) {
                OrientedEdge const side = GetFaceSide(_coarse, f, (from + m) % size);
                _s1.Add(side.edge, sign * weight * side.sign * (0.5 - static_cast<double>(m) / size));
            }
        };
        addPath(face, j, 1.0 - q);
        if (q != 0.0) {
            auto const faces = _coarse.GetEdgeFaces(edges[j]);
            auto const places = _coarse.GetEdgeFaceLocalIndices(edges[j]);
            int const other = faces[0] == face && places[0] == j ? 1 : 0;
            addPath(faces[other], places[other], -q);
        }
        _s1.EndRow(_coarse.GetFaceChildEdges(face)[j]);
    }
}

SparseRows Multiply(SparseRows const& a, SparseRows const& b, Index numColumns) {
    using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;
    auto const view = [](SparseRows const& rows, Index columns) {
        return Eigen::Map<Matrix const>(rows.GetNumRows(), columns, static_cast<Eigen::Index>(rows.weights.size()), rows.offsets.data(),
                                        rows.indices.data(), rows.weights.data());
    };
    Matrix product = view(a, b.GetNumRows()) * view(b, numColumns);
    product.makeCompressed();
    SparseRows result;
    result.offsets.assign(product.outerIndexPtr(), product.outerIndexPtr() + product.rows() + 1);
    result.indices.assign(product.innerIndexPtr(), product.innerIndexPtr() + product.nonZeros());
    result.weights.assign(product.valuePtr(), product.valuePtr() + product.nonZeros());
    return result;
}

}  // namespace

FormStencils BuildFormStencils(Far::TopologyRefiner const& refiner, int level) { return FormStencilBuilder(refiner, level).Build(); }

Wheel FindLimitWheel(Far::TopologyRefiner const& refiner, int level, Index vertex) {
    return FindWheel(refiner, refiner.GetLevel(level), nullptr, vertex);
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
