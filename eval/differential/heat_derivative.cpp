// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "eval/differential/laplacian_derivative.h"
#include "eval/parallel/rows.h"
#include "far_ext/differential/triangle.h"
#include "far_ext/topology/boundary.h"

namespace limn::eval {

namespace {

using Vector = Eigen::Vector3d;

Vector GetVector(DoubleLanes const& row) {
    return row.head<3>().matrix();
}

/// The third of the area at a vertex as a function of moves.
class AreaDerivative {
public:
    AreaDerivative(Far::TopologyLevel const& level, MultigridLevel const& graph,
                   std::span<Index const> rowsOf, far_ext::Points points)
        : _level(level), _graph(graph), _areas(graph.GetNumRows(), 0.0) {
        for (Index face = 0; face < level.GetNumFaces(); ++face) {
            auto const triangle = far_ext::MeasureTriangle(level, points, face);
            far_ext::TriangleDerivatives const derivatives(triangle, points);
            Face& found = _faces.emplace_back();
            for (size_t k = 0; k < 3; ++k) {
                found.rows[k] = rowsOf[triangle.vertices[k]];
                found.gradients[k] = derivatives.GetGradient(k) / 3.0;
                _areas[found.rows[k]] += triangle.area / 3.0;
            }
        }
    }

    double GetArea(Index row) const { return _areas[row]; }

    /// Per row what its area changes by.
    std::vector<double> Apply(LaneRows const& move) const {
        std::vector<double> ofFaces(_faces.size()), changes(_areas.size());
        ForEachRow(static_cast<Index>(_faces.size()), [&](Index face) {
            auto const& [rows, gradients] = _faces[face];
            for (size_t k = 0; k < 3; ++k)
                ofFaces[face] += gradients[k].dot(GetVector(move[rows[k]]));
        });
        ForEachRow(static_cast<Index>(changes.size()), [&](Index row) {
            for (Index face : _level.GetVertexFaces(_graph.vertices[row]))
                changes[row] += ofFaces[face];
        });
        return changes;
    }

    /// Adds the gradient of the sum of factors times areas.
    void AddTransposed(std::vector<double> const& factors, LaneRows& gradient) const {
        ForEachRow(_graph.numUnknowns, [&](Index row) {
            for (Index face : _level.GetVertexFaces(_graph.vertices[row])) {
                auto const& [rows, gradients] = _faces[face];
                size_t const k = std::find(rows.begin(), rows.end(), row) - rows.begin();
                double const factor = factors[rows[0]] + factors[rows[1]] + factors[rows[2]];
                gradient[row].head<3>() += factor * gradients[k].array();
            }
        });
    }

private:
    struct Face {
        std::array<Index, 3> rows;
        std::array<Vector, 3> gradients;  // of a third of its area, by its corners
    };

    Far::TopologyLevel _level;
    MultigridLevel const& _graph;
    std::vector<double> _areas;
    std::vector<Face> _faces;
};

/// With weights w_ij = A_j exp(-|d|^2 / 4t) / (4 pi t^2), d = v_i - v_j, and areas A_j,
///     g_i = sum_j w_ij d,
/// which moves change in three ways: through d, A_j, and the time t. Pairs are kept and multiplied
/// in float: they are all the work, and least squares need no more digits of a derivative.
class HeatDerivative final : public LaplacianDerivative {
public:
    HeatDerivative(Far::TopologyLevel const& level, MultigridLevel const& graph,
                   std::span<Index const> rowsOf, far_ext::Points points,
                   far_ext::AreaLaplacian const& laplacian, double time)
        : _graph(graph),
          _areas(level, graph, rowsOf, points),
          _halfInverseTime(static_cast<float>(0.5 / time)) {
        ListPairs(rowsOf, points, laplacian);
        DifferentiateByTime(time);
        DifferentiateTime(level, rowsOf, points);
    }

    void Apply(LaneRows const& move, LaneRows& change) const override {
        auto const areas = _areas.Apply(move);
        std::vector<FloatLanes> rows(move.size());  // moves, and by what share areas change
        ForEachRow(_graph.GetNumRows(), [&](Index row) {
            rows[row] = move[row].cast<float>();
            rows[row][3] = static_cast<float>(Share(areas[row], row));
        });
        double const time = SumRows(_graph.numUnknowns, [&](Index row) -> DoubleLanes {
                                return _timeGradient[row] * move[row];
                            }).sum();
        ForEachRow(_graph.numUnknowns, [&](Index row) {
            FloatLanes sum = FloatLanes::Zero();
            VisitPairs(row, [&](FloatLanes const& reach, Index other) {
                FloatLanes const difference = rows[row] - rows[other];
                float const grown = rows[other][3] - _halfInverseTime * Dot(reach, difference);
                sum += reach[3] * (difference + grown * reach);
            });
            change[row] = sum.cast<double>() + time * _byTime[row];
            change[row][3] = areas[row];
        });
    }

    void ApplyTransposed(LaneRows const& factors, LaneRows& gradient) const override {
        std::vector<FloatLanes> rows(factors.size());
        ForEachRow(_graph.GetNumRows(), [&](Index row) {
            DoubleLanes shares = DoubleLanes::Zero();
            for (Index c = 0; c < 3; ++c) shares[c] = Share(factors[row][c], row);
            rows[row] = shares.cast<float>();
        });
        double const time = SumRows(_graph.numUnknowns, [&](Index row) -> DoubleLanes {
                                return _byTime[row] * factors[row];
                            }).sum();
        std::vector<double> ofAreas(_graph.GetNumRows(), 0.0);
        ForEachRow(_graph.numUnknowns, [&](Index row) {
            FloatLanes sum = FloatLanes::Zero();
            float ofArea = 0.0f;
            VisitPairs(row, [&](FloatLanes const& reach, Index other) {
                FloatLanes const difference = rows[row] - rows[other];
                float const along = _halfInverseTime * Dot(reach, difference);
                sum += reach[3] * (difference - along * reach);
                ofArea -= reach[3] * Dot(reach, rows[other]);
            });
            sum[3] = 0.0f;
            gradient[row] = _areas.GetArea(row) * sum.cast<double>() + time * _timeGradient[row];
            ofAreas[row] = static_cast<double>(ofArea) + factors[row][3];
        });
        AddFactorsOfFixedAreas(factors, ofAreas);
        _areas.AddTransposed(ofAreas, gradient);
    }

private:
    static float Dot(FloatLanes const& a, FloatLanes const& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }

    /// value / area; 0 at a vertex without faces.
    double Share(double value, Index row) const {
        double const area = _areas.GetArea(row);
        return area > 0.0 ? value / area : 0.0;
    }

    template <class Visit>
    void VisitPairs(Index row, Visit const& visit) const {
        for (size_t k = _offsets[row]; k < _offsets[row + 1]; ++k) visit(_reaches[k], _others[k]);
    }

    void ListPairs(std::span<Index const> rowsOf, far_ext::Points points,
                   far_ext::AreaLaplacian const& laplacian) {
        auto const& [offsets, indices, weights] = laplacian.rows;
        for (Index row = 0; row < _graph.numUnknowns; ++row) {
            Index const vertex = _graph.vertices[row];
            for (int k = offsets[vertex]; k < offsets[vertex + 1]; ++k) {
                Index const other = rowsOf[indices[k]];
                bool const hasWeight = other != row && _areas.GetArea(other) > 0.0;
                if (!hasWeight) continue;
                Vector const d = points[vertex] - points[indices[k]];
                _reaches.push_back(DoubleLanes(d[0], d[1], d[2], -weights[k]).cast<float>());
                _others.push_back(other);
            }
            _offsets.push_back(_others.size());
        }
    }

    void DifferentiateByTime(double time) {
        for (Index row = 0; row < _graph.numUnknowns; ++row) {
            DoubleLanes sum = DoubleLanes::Zero();
            VisitPairs(row, [&](FloatLanes const& reach, Index) {
                DoubleLanes const d = reach.cast<double>();
                double const square = d.head<3>().square().sum();
                sum += d[3] * (square / (4.0 * time * time) - 2.0 / time) * d;
            });
            sum[3] = 0.0;
            _byTime.push_back(sum);
        }
    }

    /// t is the square of the mean edge length.
    void DifferentiateTime(Far::TopologyLevel const& level, std::span<Index const> rowsOf,
                           far_ext::Points points) {
        _timeGradient.assign(_graph.GetNumRows(), DoubleLanes::Zero());
        double const count = level.GetNumEdges();
        double mean = 0.0;
        for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
            auto const ends = level.GetEdgeVertices(edge);
            Vector const along = points[ends[1]] - points[ends[0]];
            double const length = along.norm();
            mean += length / count;
            _timeGradient[rowsOf[ends[0]]].head<3>() -= along.array() / (length * count);
            _timeGradient[rowsOf[ends[1]]].head<3>() += along.array() / (length * count);
        }
        for (DoubleLanes& row : _timeGradient) row *= 2.0 * mean;
    }

    /// Fixed rows have no pairs of their own; what their areas do is found from the other side.
    void AddFactorsOfFixedAreas(LaneRows const& factors, std::vector<double>& ofAreas) const {
        if (_graph.numUnknowns == _graph.GetNumRows()) return;
        for (Index row = 0; row < _graph.numUnknowns; ++row) {
            VisitPairs(row, [&](FloatLanes const& reach, Index other) {
                if (other < _graph.numUnknowns) return;
                float const factor = reach[3] * Dot(reach, factors[row].cast<float>());
                ofAreas[other] += Share(static_cast<double>(factor), other);
            });
        }
    }

    MultigridLevel const& _graph;
    AreaDerivative _areas;
    float _halfInverseTime;
    std::vector<size_t> _offsets{0};   // per unknown, one more: into the pairs
    std::vector<FloatLanes> _reaches;  // per pair: d, and w in the fourth lane
    std::vector<Index> _others;        // per pair: the other row
    LaneRows _byTime;                  // per unknown: d g / d t
    LaneRows _timeGradient;            // per row: d t / d v
};

}  // namespace

std::unique_ptr<LaplacianDerivative> DifferentiateHeat(Far::TopologyLevel const& level,
                                                       MultigridLevel const& graph,
                                                       std::span<Index const> rowsOf,
                                                       std::span<double const> positions,
                                                       far_ext::AreaLaplacian const& laplacian,
                                                       far_ext::HeatKernel const& kernel) {
    return std::make_unique<HeatDerivative>(level, graph, rowsOf, positions, laplacian,
                                            kernel.time);
}

}  // namespace limn::eval
