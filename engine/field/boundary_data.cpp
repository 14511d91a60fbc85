// SPDX-License-Identifier: Apache-2.0
#include "engine/field/boundary_data.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/io/edge_values.h"
#include "far_ext/error.h"
#include "far_ext/forms/form_operators.h"
#include "far_ext/rows/points.h"

namespace limn::engine {

namespace {

using eval::BoundaryData;
using eval::BoundaryProblem;

/// The edges of a boundary loop as their faces run along them, and its vertices.
struct Loop {
    std::vector<far_ext::OrientedEdge> edges;
    std::vector<Index> vertices;
};

bool IsBoundary(Far::TopologyLevel const& level, Index edge) {
    return level.GetEdgeFaces(edge).size() == 1;
}

far_ext::OrientedEdge GetSideOf(Far::TopologyLevel const& level, Index edge) {
    return far_ext::GetFaceSide(level, level.GetEdgeFaces(edge)[0],
                                level.GetEdgeFaceLocalIndices(edge)[0]);
}

/// In the order of their lowest edges.
std::vector<Loop> FindLoops(Far::TopologyLevel const& level) {
    std::vector<Loop> loops;
    std::vector<char> isKnown(level.GetNumEdges(), 0);
    for (Index first = 0; first < level.GetNumEdges(); ++first) {
        if (!IsBoundary(level, first) || isKnown[first]) continue;
        Loop& loop = loops.emplace_back();
        for (Index edge = first; !isKnown[edge];) {
            isKnown[edge] = 1;
            auto const side = GetSideOf(level, edge);
            auto const ends = level.GetEdgeVertices(edge);
            bool const endsHigher = side.sign > 0.0;
            Index const low = std::min(ends[0], ends[1]), high = std::max(ends[0], ends[1]);
            loop.edges.push_back(side);
            loop.vertices.push_back(endsHigher ? low : high);
            Index const end = endsHigher ? high : low;
            for (Index next : level.GetVertexEdges(end)) {
                if (!IsBoundary(level, next) || next == edge) continue;
                edge = next;
                break;
            }
        }
    }
    return loops;
}

/// Fills in data from the kind of all boundaries, then loops, then edges.
class DataMaker {
public:
    DataMaker(Model const& model, FieldOptions const& options)
        : _model(model), _options(options), _loops(FindLoops(model.GetLevel())) {}

    std::vector<Loop> const& GetLoops() const { return _loops; }

    BoundaryData Make() {
        auto const count = static_cast<size_t>(_model.GetLevel().GetNumEdges());
        _data = {std::vector<char>(count, _options.atBoundary == eval::AtBoundary::Normal),
                 std::vector<double>(count, 0.0)};
        std::vector<char> isSet(_loops.size(), 0);
        for (BoundaryLoop const& wanted : _options.loops) {
            size_t const number = FindLoop(wanted.vertex);
            if (isSet[number]) {
                throw Error(ErrorCode::BadMesh,
                            fmt::format("{}: the boundary loop of vertex {} is given twice",
                                        _model.GetPath(), wanted.vertex));
            }
            isSet[number] = 1;
            Spread(_loops[number], wanted);
        }
        for (BoundaryEdge const& wanted : _options.boundaryEdges) {
            if (!IsBoundary(_model.GetLevel(), wanted.edge)) {
                auto const ends = _model.GetLevel().GetEdgeVertices(wanted.edge);
                throw Error(ErrorCode::BadMesh,
                            fmt::format("{}: the edge from vertex {} to {} is on no boundary",
                                        _model.GetPath(), ends[0], ends[1]));
            }
            _data.isCirculation[wanted.edge] = wanted.isCirculation;
            _data.values[wanted.edge] = wanted.value;
        }
        return std::move(_data);
    }

private:
    size_t FindLoop(Index vertex) const {
        auto const hasIt = [&](Loop const& loop) {
            return std::ranges::find(loop.vertices, vertex) != loop.vertices.end();
        };
        auto const found = std::ranges::find_if(_loops, hasIt);
        if (found == _loops.end()) {
            throw Error(ErrorCode::BadMesh,
                        fmt::format("{}: vertex {} is on no boundary; `loops` takes any vertex of "
                                    "a boundary loop",
                                    _model.GetPath(), vertex));
        }
        return static_cast<size_t>(found - _loops.begin());
    }

    /// A loop's total over its edges, by their lengths.
    void Spread(Loop const& loop, BoundaryLoop const& wanted) {
        far_ext::Points const points(_model.GetPositions());
        auto const getLength = [&](Index edge) {
            auto const ends = _model.GetLevel().GetEdgeVertices(edge);
            return (points[ends[1]] - points[ends[0]]).norm();
        };
        double total = 0.0;
        for (auto const& [edge, sign] : loop.edges) total += getLength(edge);
        for (auto const& [edge, sign] : loop.edges) {
            double const value = wanted.total * getLength(edge) / total;
            _data.isCirculation[edge] = wanted.isCirculation;
            _data.values[edge] = wanted.isCirculation ? sign * value : value;
        }
    }

    Model const& _model;
    FieldOptions const& _options;
    std::vector<Loop> _loops;
    BoundaryData _data;
};

std::vector<double> FindArcFluxes(Model const& model, FieldOptions const& options,
                                  eval::BoundaryArcs const& arcs) {
    std::vector<double> fluxes(static_cast<size_t>(arcs.count), 0.0);
    std::vector<char> isSet(fluxes.size(), 0);
    for (FieldStrength const& wanted : options.arcFluxes) {
        auto const refuse = [&](char const* why) {
            throw Error(ErrorCode::BadMesh, fmt::format("{}: `arcFluxes` at vertex {}: {}",
                                                        model.GetPath(), wanted.element, why));
        };
        if (wanted.element < 0 || wanted.element >= model.GetLevel().GetNumVertices())
            refuse("there is no such vertex");
        int const arc = arcs.ofVertex[wanted.element];
        if (arc < 0) refuse("no boundary edge there has a given circulation");
        if (arcs.isFirst[arc])
            refuse("it is on the first arc of its component, which takes what the others do not");
        if (isSet[arc]) refuse("its arc has a flux already");
        isSet[arc] = 1;
        fluxes[arc] = wanted.strength;
    }
    return fluxes;
}

/// Refuses numbers that cannot be met together, or spreads what is missing over the component.
void BalanceBounded(Model const& model, BoundaryProblem const& problem, bool isBalanced,
                    std::vector<double>& sources, std::vector<double>& vortices) {
    constexpr double kRounding = 1e-12;
    auto const& components = problem.GetComponents();
    auto const balances = problem.FindBalances(sources, vortices);
    auto const level = model.GetLevel();
    auto const settle = [&](int component, double given, double left, double size, char const* what,
                            auto const& spread) {
        if (std::abs(given - left) <= kRounding * size) return;
        if (isBalanced) return spread(given - left);
        auto const face =
            std::ranges::find(components.ofFace, component) - components.ofFace.begin();
        throw Error(ErrorCode::BadMesh,
                    fmt::format("{}: on the component of face {} {} {:.6g} and {:.6g}; they have "
                                "to be equal",
                                model.GetPath(), face, what, given, left));
    };
    for (int c = 0; c < components.count; ++c) {
        auto const& balance = balances[c];
        if (!balance.hasArc) {
            settle(c, balance.sources, balance.fluxes, balance.size,
                   "what sources give and what flows out of boundaries are", [&](double excess) {
                       std::vector<Index> own;
                       for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
                           auto const faces = level.GetVertexFaces(vertex);
                           if (faces.size() > 0 && components.ofFace[faces[0]] == c)
                               own.push_back(vertex);
                       }
                       for (Index vertex : own)
                           sources[vertex] -= excess / static_cast<double>(own.size());
                   });
        }
        if (!balance.hasFreeEdge) {
            settle(c, balance.vortices, balance.circulations, balance.size,
                   "vortices and the circulations along boundaries add up to", [&](double excess) {
                       double const count =
                           static_cast<double>(std::ranges::count(components.ofFace, c));
                       for (size_t face = 0; face < vortices.size(); ++face) {
                           if (components.ofFace[face] == c) vortices[face] -= excess / count;
                       }
                   });
        }
    }
}

/// What the field does along each loop.
std::vector<BoundaryAudit::Loop> Describe(std::vector<Loop> const& loops, BoundaryData const& data,
                                          std::span<double const> form,
                                          std::span<double const> outflow) {
    std::vector<BoundaryAudit::Loop> described;
    for (Loop const& loop : loops) {
        auto& found = described.emplace_back();
        found.vertex = *std::ranges::min_element(loop.vertices);
        size_t numGiven = 0;
        bool hasValue = false;
        for (auto const& [edge, sign] : loop.edges) {
            found.circulation += sign * form[edge];
            numGiven += data.isCirculation[edge] != 0;
            hasValue |= data.values[edge] != 0.0;
        }
        for (Index vertex : loop.vertices) found.flux += outflow[vertex];
        if (numGiven == 0)
            found.kind = hasValue ? "flux" : "tangent";
        else if (numGiven == loop.edges.size())
            found.kind = hasValue ? "circulation" : "normal";
        else
            found.kind = "mixed";
    }
    std::ranges::sort(described, {}, &BoundaryAudit::Loop::vertex);
    return described;
}

}  // namespace

std::vector<BoundaryEdge> ReadBoundaryEdges(std::string const& path,
                                            Far::TopologyLevel const& level) {
    std::vector<BoundaryEdge> edges;
    for (EdgeValue const& row : ReadEdgeTable(path, "value", level, "circulation|flux")) {
        bool const isCirculation = row.kind == 0;
        double const sign = isCirculation ? far_ext::GetSignFrom(level, row.edge, row.from) : 1.0;
        edges.push_back({row.edge, isCirculation, sign * row.value});
    }
    return edges;
}

BoundedField DesignBounded(Model const& model, FieldOptions const& options,
                           std::vector<double> sources, std::vector<double> vortices) {
    if (options.harmonics) {
        throw Error(ErrorCode::BadOption,
                    "`harmonics` go with one kind of boundary only; beside `loops`, "
                    "`boundaryEdges` and `arcFluxes` circulations say the same");
    }
    DataMaker maker(model, options);
    BoundaryData const data = maker.Make();
    BoundaryProblem const problem(model.GetLevel(), model.GetPositions(), data);
    auto const arcFluxes = FindArcFluxes(model, options, problem.GetArcs());
    BalanceBounded(model, problem, options.isBalanced, sources, vortices);

    BoundedField field;
    field.form = problem.Solve(sources, vortices, arcFluxes);
    field.audit.residual = problem.FindResidual(field.form, sources, vortices, arcFluxes);
    field.audit.loops =
        Describe(maker.GetLoops(), data, field.form, problem.FindOutflow(field.form, sources));
    return field;
}

}  // namespace limn::engine
