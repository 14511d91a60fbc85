// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/boundary_problem.h"

#include <algorithm>
#include <cmath>

#include "eval/forms/laplace_solver.h"
#include "far_ext/forms/form_operators.h"
#include "far_ext/topology/boundary.h"

namespace limn::eval {

BoundaryProblem::BoundaryProblem(Far::TopologyLevel const& level, std::span<double const> positions,
                                 BoundaryData data)
    : _level(level),
      _components(far_ext::FaceComponents::Find(level)),
      _stars(far_ext::FindHodgeStars(level, positions)),
      _data(std::move(data)) {
    _componentOfVertex.assign(level.GetNumVertices(), -1);
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        for (Index vertex : level.GetFaceVertices(face))
            _componentOfVertex[vertex] = _components.ofFace[face];
    }
    FindArcs();
    _unknownOfVertex.assign(level.GetNumVertices(), -1);
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (_arcs.ofVertex[vertex] < 0) _unknownOfVertex[vertex] = _numUnknowns++;
    }
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (_arcs.ofVertex[vertex] >= 0)
            _unknownOfVertex[vertex] = _numUnknowns + _arcs.ofVertex[vertex];
    }
    _numUnknowns += _arcs.count;
}

/// Grows each arc from its lowest edge.
void BoundaryProblem::FindArcs() {
    _arcs.ofVertex.assign(_level.GetNumVertices(), -1);
    std::vector<char> hasArc(_components.count, 0);
    std::vector<Index> reached;
    for (Index edge = 0; edge < _level.GetNumEdges(); ++edge) {
        Index const start = _level.GetEdgeVertices(edge)[0];
        if (!IsGiven(edge) || _arcs.ofVertex[start] >= 0) continue;
        int const component = _componentOfVertex[start];
        reached.assign(1, start);
        _arcs.ofVertex[start] = _arcs.count;
        for (size_t next = 0; next < reached.size(); ++next) {
            for (Index along : _level.GetVertexEdges(reached[next])) {
                if (!IsGiven(along)) continue;
                Index const end = far_ext::GetOtherEnd(_level, along, reached[next]);
                if (_arcs.ofVertex[end] >= 0) continue;
                _arcs.ofVertex[end] = _arcs.count;
                reached.push_back(end);
            }
        }
        _arcs.component.push_back(component);
        _arcs.isFirst.push_back(!hasArc[component]);
        hasArc[component] = 1;
        ++_arcs.count;
    }
}

std::vector<BoundaryProblem::Balance> BoundaryProblem::FindBalances(
    std::span<double const> sources, std::span<double const> vortices) const {
    std::vector<Balance> balances(_components.count);
    for (int const component : _arcs.component) balances[component].hasArc = true;
    auto const add = [&](int component, double Balance::* part, double value) {
        balances[component].*part += value;
        balances[component].size += std::abs(value);
    };
    for (size_t i = 0; i < sources.size(); ++i) {
        if (_componentOfVertex[i] >= 0) add(_componentOfVertex[i], &Balance::sources, sources[i]);
    }
    for (size_t i = 0; i < vortices.size(); ++i)
        add(_components.ofFace[i], &Balance::vortices, vortices[i]);
    for (Index edge = 0; edge < _level.GetNumEdges(); ++edge) {
        if (!IsBoundary(edge)) continue;
        Index const face = _level.GetEdgeFaces(edge)[0];
        int const component = _components.ofFace[face];
        if (_data.isCirculation[edge]) {
            auto const side =
                far_ext::GetFaceSide(_level, face, _level.GetEdgeFaceLocalIndices(edge)[0]);
            add(component, &Balance::circulations, side.sign * _data.values[edge]);
        } else {
            balances[component].hasFreeEdge = true;
            add(component, &Balance::fluxes, _data.values[edge]);
        }
    }
    return balances;
}

std::vector<double> BoundaryProblem::FindInflow(std::span<double const> form) const {
    std::vector<double> inflow(_level.GetNumVertices(), 0.0);
    for (Index edge = 0; edge < _level.GetNumEdges(); ++edge) {
        auto const ends = _level.GetEdgeVertices(edge);
        double const flow = _stars.edge[edge] * form[edge];
        inflow[std::max(ends[0], ends[1])] += flow;
        inflow[std::min(ends[0], ends[1])] -= flow;
    }
    return inflow;
}

std::vector<double> BoundaryProblem::FindOutflow(std::span<double const> form,
                                                 std::span<double const> sources) const {
    auto outflow = FindInflow(form);
    for (size_t i = 0; i < outflow.size(); ++i) outflow[i] += sources[i];
    return outflow;
}

/// Per unknown, of numbers per vertex.
std::vector<double> BoundaryProblem::SumUp(std::span<double const> ofVertices) const {
    std::vector<double> sums(_numUnknowns, 0.0);
    for (size_t i = 0; i < ofVertices.size(); ++i) sums[_unknownOfVertex[i]] += ofVertices[i];
    return sums;
}

/// What flows into each unknown.
std::vector<double> BoundaryProblem::MakeRight(std::span<double const> sources,
                                               std::span<double const> arcFluxes) const {
    std::vector<double> inflow(sources.size());
    for (size_t i = 0; i < inflow.size(); ++i) inflow[i] = -sources[i];
    for (Index edge = 0; edge < _level.GetNumEdges(); ++edge) {
        if (!IsBoundary(edge) || _data.isCirculation[edge]) continue;
        for (Index vertex : _level.GetEdgeVertices(edge))
            inflow[vertex] += 0.5 * _data.values[edge];
    }
    auto right = SumUp(inflow);
    for (int arc = 0; arc < _arcs.count; ++arc)
        right[_numUnknowns - _arcs.count + arc] += arcFluxes[arc];
    return right;
}

/// Unknowns of the potential that are 0: the first arc of a component, or its lowest vertex where
/// it has none.
std::vector<char> BoundaryProblem::ChooseFixed() const {
    std::vector<char> isFixed(_numUnknowns, 0), isPinned(_components.count, 0);
    for (int arc = 0; arc < _arcs.count; ++arc) {
        if (!_arcs.isFirst[arc]) continue;
        isFixed[_numUnknowns - _arcs.count + arc] = 1;
        isPinned[_arcs.component[arc]] = 1;
    }
    for (size_t vertex = 0; vertex < _componentOfVertex.size(); ++vertex) {
        int const component = _componentOfVertex[vertex];
        bool const isNeeded = component < 0 || !isPinned[component];
        if (!isNeeded) continue;
        isFixed[_unknownOfVertex[vertex]] = 1;
        if (component >= 0) isPinned[component] = 1;
    }
    return isFixed;
}

/// The given circulations, and *1^-1 d1^T psi on the other edges so that the curl is that asked
/// for.
std::vector<double> BoundaryProblem::MakeVortexPart(std::span<double const> vortices) const {
    std::vector<double> form(_level.GetNumEdges(), 0.0);
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<char> isFixed(vortices.size(), 0), isOpen(_components.count, 0);
    for (Index edge = 0; edge < _level.GetNumEdges(); ++edge) {
        auto const faces = _level.GetEdgeFaces(edge);
        if (IsGiven(edge)) {
            form[edge] = _data.values[edge];
        } else if (faces.size() == 1) {
            entries.emplace_back(faces[0], faces[0], 1.0 / _stars.edge[edge]);
            isOpen[_components.ofFace[faces[0]]] = 1;
        } else if (faces.size() == 2) {
            AddEdge(faces[0], faces[1], 1.0 / _stars.edge[edge], entries);
        }
    }
    for (size_t face = 0; face < isFixed.size(); ++face) {
        int const component = _components.ofFace[face];
        if (!isOpen[component]) isFixed[face] = 1;
        isOpen[component] = 1;
    }
    LaplaceSolver solver(isFixed, entries);
    auto const d1 = far_ext::BuildD1(_level);
    constexpr int kSteps = 2;  // the second one gives back the digits that large values of psi took
    for (int step = 0; step < kSteps; ++step) {
        auto missing = d1.Apply(form);
        for (size_t face = 0; face < missing.size(); ++face)
            missing[face] = vortices[face] - missing[face];
        auto const psi = solver.Solve(missing);
        for (Index face = 0; face < _level.GetNumFaces(); ++face) {
            for (int k = d1.offsets[face]; k < d1.offsets[face + 1]; ++k) {
                Index const edge = d1.indices[k];
                if (!IsGiven(edge)) form[edge] += d1.weights[k] * psi[face] / _stars.edge[edge];
            }
        }
    }
    return form;
}

std::vector<double> BoundaryProblem::Solve(std::span<double const> sources,
                                           std::span<double const> vortices,
                                           std::span<double const> arcFluxes) const {
    auto form = MakeVortexPart(vortices);
    auto right = MakeRight(sources, arcFluxes);
    auto const inflow = SumUp(FindInflow(form));
    for (size_t i = 0; i < right.size(); ++i) right[i] -= inflow[i];
    std::vector<Eigen::Triplet<double>> entries;
    for (Index edge = 0; edge < _level.GetNumEdges(); ++edge) {
        auto const ends = _level.GetEdgeVertices(edge);
        int const a = _unknownOfVertex[ends[0]], b = _unknownOfVertex[ends[1]];
        if (a != b) AddEdge(a, b, _stars.edge[edge], entries);
    }
    LaplaceSolver solver(ChooseFixed(), entries);
    auto const found = solver.Solve(right);
    std::vector<double> potential(_unknownOfVertex.size());
    for (size_t i = 0; i < potential.size(); ++i) potential[i] = found[_unknownOfVertex[i]];
    auto const gradient = far_ext::TakeDifferences(_level, potential);
    for (Index edge = 0; edge < _level.GetNumEdges(); ++edge) {
        if (!IsGiven(edge)) form[edge] += gradient[edge];
    }
    return form;
}

double BoundaryProblem::FindResidual(std::vector<double> const& form,
                                     std::span<double const> sources,
                                     std::span<double const> vortices,
                                     std::span<double const> arcFluxes) const {
    double largest = 0.0, size = 0.0;
    auto const compare = [&](double found, double wanted) {
        largest = std::max(largest, std::abs(found - wanted));
        size = std::max({size, std::abs(found), std::abs(wanted)});
    };
    auto const right = MakeRight(sources, arcFluxes), inflow = SumUp(FindInflow(form));
    size_t const firstArc = inflow.size() - static_cast<size_t>(_arcs.count);
    for (size_t i = 0; i < inflow.size(); ++i) {
        if (i < firstArc || !_arcs.isFirst[i - firstArc]) compare(inflow[i], right[i]);
    }
    auto const curl = far_ext::BuildD1(_level).Apply(form);
    for (size_t face = 0; face < curl.size(); ++face) compare(curl[face], vortices[face]);
    for (Index edge = 0; edge < _level.GetNumEdges(); ++edge) {
        if (IsGiven(edge)) compare(form[edge], _data.values[edge]);
    }
    return size > 0.0 ? largest / size : 0.0;
}

}  // namespace limn::eval
