// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/field_index.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "far_ext/forms/form_operators.h"

namespace limn::eval {

namespace {

// Of what flows along the sides near by.
constexpr double kNothing = 1e-4;
constexpr double kLittle = 0.2;

bool IsOpen(Far::TopologyLevel const& level, Index vertex) {
    return level.GetVertexEdges(vertex).size() != level.GetVertexFaces(vertex).size();
}

/// What flows along the weakest of the sides round a vertex, its faces' without the spokes; 0 if
/// they do not all run one way.
double FindFlowRound(Far::TopologyLevel const& level, std::span<double const> form, Index vertex) {
    auto const faces = level.GetVertexFaces(vertex);
    auto const corners = level.GetVertexFaceLocalIndices(vertex);
    double least = std::numeric_limits<double>::infinity(), greatest = -least;
    for (int i = 0; i < faces.size(); ++i) {
        int const size = level.GetFaceEdges(faces[i]).size();
        for (int m = 1; m < size - 1; ++m) {
            auto const side = far_ext::GetFaceSide(level, faces[i], (corners[i] + m) % size);
            least = std::min(least, side.sign * form[side.edge]);
            greatest = std::max(greatest, side.sign * form[side.edge]);
        }
    }
    return std::max({least, -greatest, 0.0});
}

/// Which way the field runs along each edge.
class Directions {
public:
    Directions(Far::TopologyLevel const& level, std::span<double const> form)
        : _level(level), _isPositive(form.size()) {
        for (size_t edge = 0; edge < form.size(); ++edge) _isPositive[edge] = form[edge] >= 0.0;
        SettleBoundaries(form);
        for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
            if (!IsMiddleOfVortex(form, vertex)) continue;
            for (Index spoke : level.GetVertexEdges(vertex))
                _isPositive[spoke] = far_ext::GetSignFrom(level, spoke, vertex) > 0.0;
        }
    }

    int CountChangesRound(Index vertex) const {
        auto const edges = _level.GetVertexEdges(vertex);
        int const numPairs = IsOpen(_level, vertex) ? edges.size() - 1 : edges.size();
        auto const leaves = [&](int i) {
            Index const edge = edges[i % edges.size()];
            return IsAlong({edge, far_ext::GetSignFrom(_level, edge, vertex)});
        };
        int changes = 0;
        for (int i = 0; i < numPairs; ++i) changes += leaves(i) != leaves(i + 1);
        return changes;
    }

    int CountChangesAlong(Index face) const {
        int const size = _level.GetFaceEdges(face).size();
        int changes = 0;
        for (int j = 0; j < size; ++j) {
            changes += IsAlong(far_ext::GetFaceSide(_level, face, j)) !=
                       IsAlong(far_ext::GetFaceSide(_level, face, (j + 1) % size));
        }
        return changes;
    }

private:
    bool IsAlong(far_ext::OrientedEdge side) const {
        return (_isPositive[side.edge] != 0) == (side.sign > 0.0);
    }

    /// Boundary edges along which nothing flows run as their face: a field straight across a
    /// boundary is not singular there.
    void SettleBoundaries(std::span<double const> form) {
        for (Index face = 0; face < _level.GetNumFaces(); ++face) {
            auto const sides = _level.GetFaceEdges(face);
            double largest = 0.0;
            for (Index side : sides) largest = std::max(largest, std::abs(form[side]));
            for (int j = 0; j < sides.size(); ++j) {
                bool const isOnBoundary = _level.GetEdgeFaces(sides[j]).size() == 1;
                if (isOnBoundary && std::abs(form[sides[j]]) <= kNothing * largest)
                    _isPositive[sides[j]] = far_ext::GetFaceSide(_level, face, j).sign > 0.0;
            }
        }
    }

    /// Whether the field turns round a vertex, while nothing flows along its spokes; or so little
    /// that their signs alone would make it a saddle among vortices.
    bool IsMiddleOfVortex(std::span<double const> form, Index vertex) const {
        auto const spokes = _level.GetVertexEdges(vertex);
        if (IsOpen(_level, vertex) || spokes.size() == 0) return false;
        double const around = FindFlowRound(_level, form, vertex);
        if (around == 0.0) return false;
        double strongest = 0.0;
        for (Index spoke : spokes) strongest = std::max(strongest, std::abs(form[spoke]));
        bool const isSaddle = CountChangesRound(vertex) > 2;
        return strongest <= (isSaddle ? kLittle : kNothing) * around;
    }

    Far::TopologyLevel _level;  // a view
    std::vector<char> _isPositive;
};

}  // namespace

FieldIndices FindFieldIndices(Far::TopologyLevel const& level, std::span<double const> form) {
    FieldIndices result;
    Directions const directions(level, form);
    auto const add = [&](bool isFace, Index element, double index) {
        if (index != 0.0) result.singularities.push_back({isFace, element, index});
        result.sum += index;
    };
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (level.GetVertexFaces(vertex).size() == 0) continue;
        int const changes = directions.CountChangesRound(vertex);
        add(false, vertex, IsOpen(level, vertex) ? 0.5 * (1 - changes) : 1.0 - 0.5 * changes);
    }
    for (Index face = 0; face < level.GetNumFaces(); ++face)
        add(true, face, 1.0 - 0.5 * directions.CountChangesAlong(face));
    return result;
}

}  // namespace limn::eval
