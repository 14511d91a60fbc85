// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/field_designer.h"

#include <algorithm>
#include <cmath>

#include "eval/forms/laplace_solver.h"
#include "eval/forms/tree_cotree.h"
#include "far_ext/error.h"
#include "far_ext/forms/form_operators.h"

namespace limn::eval {

FieldDesigner::~FieldDesigner() = default;

FieldDesigner::FieldDesigner(Far::TopologyLevel const& level, std::span<double const> positions,
                             AtBoundary atBoundary)
    : _level(level),
      _atBoundary(atBoundary),
      _components(far_ext::FaceComponents::Find(level)),
      _stars(far_ext::FindHodgeStars(level, positions)),
      _d1(far_ext::BuildD1(level)) {
    _componentOfVertex.assign(level.GetNumVertices(), -1);
    _isOpen.assign(_components.count, 0);
    _isFixedVertex.assign(_componentOfVertex.size(), 0);
    _isEmptyEdge.assign(level.GetNumEdges(), 0);
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        for (Index vertex : level.GetFaceVertices(face))
            _componentOfVertex[vertex] = _components.ofFace[face];
    }
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        if (level.GetEdgeFaces(edge).size() != 1) continue;
        _isOpen[_components.ofFace[level.GetEdgeFaces(edge)[0]]] = 1;
        if (atBoundary != AtBoundary::Normal) continue;
        _isEmptyEdge[edge] = 1;
        for (Index vertex : level.GetEdgeVertices(edge)) _isFixedVertex[vertex] = 1;
    }
}

/// \param freeBoundary  the kind of boundary at which strengths may leave
std::vector<FieldDesigner::Imbalance> FieldDesigner::FindImbalance(
    std::span<double const> strengths, std::vector<int> const& componentOf,
    AtBoundary freeBoundary) const {
    std::vector<double> sums(_components.count, 0.0), sizes(sums);
    for (size_t i = 0; i < strengths.size(); ++i) {
        if (componentOf[i] < 0) continue;
        sums[componentOf[i]] += strengths[i];
        sizes[componentOf[i]] += std::abs(strengths[i]);
    }
    std::vector<Imbalance> found;
    for (int c = 0; c < _components.count; ++c) {
        bool const canLeave = _isOpen[c] && _atBoundary == freeBoundary;
        if (!canLeave && std::abs(sums[c]) > 1e-12 * sizes[c]) found.push_back({c, sums[c]});
    }
    return found;
}

std::vector<FieldDesigner::Imbalance> FieldDesigner::FindSourceImbalance(
    std::span<double const> sources) const {
    return FindImbalance(sources, _componentOfVertex, AtBoundary::Normal);
}

std::vector<FieldDesigner::Imbalance> FieldDesigner::FindVortexImbalance(
    std::span<double const> vortices) const {
    return FindImbalance(vortices, _components.ofFace, AtBoundary::Tangent);
}

int FieldDesigner::CountHarmonics() const {
    std::vector<int> const euler = _components.FindEulerCharacteristics(_level);
    int count = 0;
    for (int c = 0; c < _components.count; ++c) count += (_isOpen[c] ? 1 : 2) - euler[c];
    return count;
}

std::vector<double> FieldDesigner::FindPotential(std::span<double const> sources) {
    if (!_vertices) {
        std::vector<char> isFixed = _isFixedVertex, isPinned(_components.count, 0);
        for (size_t vertex = 0; vertex < isFixed.size(); ++vertex) {
            int const component = _componentOfVertex[vertex];
            if (component < 0) {
                isFixed[vertex] = 1;
            } else if (!(_isOpen[component] && _atBoundary == AtBoundary::Normal) &&
                       !isPinned[component]) {
                isPinned[component] = isFixed[vertex] = 1;
            }
        }
        std::vector<Eigen::Triplet<double>> entries;
        for (Index edge = 0; edge < _level.GetNumEdges(); ++edge) {
            auto const ends = _level.GetEdgeVertices(edge);
            for (int a = 0; a < 2; ++a) {
                for (int b = 0; b < 2; ++b)
                    entries.emplace_back(ends[a], ends[b],
                                         a == b ? _stars.edge[edge] : -_stars.edge[edge]);
            }
        }
        _vertices = std::make_unique<LaplaceSolver>(isFixed, entries);
    }
    std::vector<double> right(sources.size());
    for (size_t i = 0; i < right.size(); ++i) right[i] = -sources[i];
    return _vertices->Solve(right);
}

std::vector<double> FieldDesigner::MakeGradient(std::span<double const> sources) {
    return far_ext::TakeDifferences(_level, FindPotential(sources));
}

std::vector<double> FieldDesigner::MakeVortex(std::span<double const> vortices) {
    if (!_faces) {
        std::vector<char> isFixed(vortices.size(), 0), isPinned(_components.count, 0);
        for (size_t face = 0; face < isFixed.size(); ++face) {
            int const component = _components.ofFace[face];
            if ((_isOpen[component] && _atBoundary == AtBoundary::Tangent) || isPinned[component])
                continue;
            isPinned[component] = isFixed[face] = 1;
        }
        std::vector<Eigen::Triplet<double>> entries;
        for (Index edge = 0; edge < _level.GetNumEdges(); ++edge) {
            if (_isEmptyEdge[edge]) continue;
            auto const faces = _level.GetEdgeFaces(edge);
            double const weight = 1.0 / _stars.edge[edge];
            for (Index face : faces) entries.emplace_back(face, face, weight);
            if (faces.size() < 2) continue;
            entries.emplace_back(faces[0], faces[1], -weight);
            entries.emplace_back(faces[1], faces[0], -weight);
        }
        _faces = std::make_unique<LaplaceSolver>(isFixed, entries);
    }
    std::vector<double> form(_level.GetNumEdges(), 0.0), missing(vortices.begin(), vortices.end());
    for (int step = 0; step < 2;
         ++step) {  // the second one gives back the digits that large values of psi took
        std::vector<double> const psi = _faces->Solve(missing);
        for (Index face = 0; face < _level.GetNumFaces(); ++face) {
            for (int k = _d1.offsets[face]; k < _d1.offsets[face + 1]; ++k) {
                Index const edge = _d1.indices[k];
                if (!_isEmptyEdge[edge])
                    form[edge] += _d1.weights[k] * psi[face] / _stars.edge[edge];
            }
        }
        if (step > 0) break;
        std::vector<double> const curl = FindCurl(form);
        for (size_t face = 0; face < missing.size(); ++face) missing[face] -= curl[face];
    }
    return form;
}

std::vector<double> FieldDesigner::FindInflow(std::span<double const> form) const {
    std::vector<double> inflow(_level.GetNumVertices(), 0.0);
    for (Index edge = 0; edge < _level.GetNumEdges(); ++edge) {
        auto const ends = _level.GetEdgeVertices(edge);
        double const flow = _stars.edge[edge] * form[edge];
        inflow[std::max(ends[0], ends[1])] += flow;
        inflow[std::min(ends[0], ends[1])] -= flow;
    }
    for (size_t vertex = 0; vertex < inflow.size(); ++vertex) {
        if (_isFixedVertex[vertex]) inflow[vertex] = 0.0;
    }
    return inflow;
}

std::vector<double> FieldDesigner::FindCurl(std::vector<double> const& form) const {
    return _d1.Apply(form);
}

double FieldDesigner::FindNorm(std::span<double const> form) const {
    double sum = 0.0;
    for (size_t edge = 0; edge < form.size(); ++edge)
        sum += _stars.edge[edge] * form[edge] * form[edge];
    return std::sqrt(sum);
}

std::vector<double> FieldDesigner::FindGradientPart(std::span<double const> form) {
    std::vector<double> sources = FindInflow(form);
    for (double& source : sources) source = -source;
    return MakeGradient(sources);
}

std::vector<std::vector<double>> const& FieldDesigner::GetHarmonics() {
    if (!_harmonics.empty() || CountHarmonics() == 0) return _harmonics;
    for (auto const& closed : FindClosedForms(_level, _atBoundary == AtBoundary::Normal)) {
        _harmonics.push_back(closed);
        std::vector<double> const gradient = FindGradientPart(closed);
        for (size_t i = 0; i < closed.size(); ++i) _harmonics.back()[i] -= gradient[i];
    }
    return _harmonics;
}

HodgeParts FieldDesigner::Decompose(std::vector<double> const& form) {
    HodgeParts parts;
    parts.gradient = FindGradientPart(form);
    parts.vortex = MakeVortex(FindCurl(form));
    parts.harmonic.assign(form.begin(), form.end());
    for (size_t i = 0; i < form.size(); ++i)
        parts.harmonic[i] -= parts.gradient[i] + parts.vortex[i];
    return parts;
}

}  // namespace limn::eval
