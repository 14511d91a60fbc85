// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/area_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "eval/differential/laplacian_derivative.h"
#include "eval/parallel/rows.h"
#include "far_ext/error.h"
#include "far_ext/rows/breadth_first.h"
#include "far_ext/rows/points.h"

namespace limn::eval {

namespace {

/// Positions of the vertices of every level: each keeps its own place of the last one. Levels need
/// no more than angles of about the right size [Differential 6].
std::vector<std::vector<double>> RestrictPositions(Far::TopologyRefiner const& refiner,
                                                   std::span<double const> positions) {
    std::vector<std::vector<double>> levels(refiner.GetMaxLevel() + 1);
    levels.back().assign(positions.begin(), positions.end());
    for (int k = refiner.GetMaxLevel() - 1; k >= 0; --k) {
        auto const level = refiner.GetLevel(k);
        far_ext::Points const finer(levels[k + 1]);
        for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
            auto const p = finer[level.GetVertexChildVertex(vertex)];
            levels[k].insert(levels[k].end(), {p[0], p[1], p[2]});
        }
    }
    return levels;
}

/// Levels below the last only help to converge: a wide angle's negative weight would hinder there,
/// and where a triangle has no area uniform weights serve.
std::vector<double> FindCoarseWeights(Far::TopologyLevel const& level,
                                      std::span<double const> positions) {
    try {
        auto weights = far_ext::FindCotangentWeights(level, positions);
        for (double& weight : weights) weight = std::max(weight, 1e-3);
        return weights;
    } catch (Error const&) {
        return std::vector<double>(level.GetNumEdges(), 1.0);
    }
}

/// Cotangent weights per edge of every level.
std::vector<EdgeWeights> FindWeights(Far::TopologyRefiner const& refiner,
                                     std::span<double const> positions) {
    auto const places = RestrictPositions(refiner, positions);
    std::vector<EdgeWeights> weights;
    weights.reserve(static_cast<size_t>(refiner.GetNumLevels()));
    for (int k = 0; k < refiner.GetMaxLevel(); ++k)
        weights.push_back({FindCoarseWeights(refiner.GetLevel(k), places[k]), {}});
    weights.push_back(
        {far_ext::FindCotangentWeights(refiner.GetLevel(refiner.GetMaxLevel()), positions), {}});
    return weights;
}

/// Where Delta is missed, per row: root (Delta - h) for h = M L V and the root of its weight.
struct Misfit {
    far_ext::AreaLaplacian laplacian;
    far_ext::HeatKernel kernel;
    std::vector<double> areas;     // per vertex
    LaneRows values;               // 0 at fixed vertices
    std::vector<double> byImages;  // per unknown: derivative of values by L V
    LaneRows byAreas;              // derivative of values by the vertex' area
    double squares = std::numeric_limits<double>::infinity();  // sum of values squared
};

double SumSquares(LaneRows const& rows) {
    return SumRows(static_cast<Index>(rows.size()),
                   [&](Index row) -> DoubleLanes { return rows[row].square(); })
        .sum();
}

/// The least-squares problem, linearised where it stands.
class AreaFit {
public:
    AreaFit(Far::TopologyRefiner const& refiner, Multigrid& multigrid, AreaLaplacianKind kind,
            std::span<double const> deltas, std::span<double const> start,
            AreaFitOptions const& options)
        : _refiner(refiner),
          _level(refiner.GetLevel(refiner.GetMaxLevel())),
          _multigrid(multigrid),
          _graph(multigrid.GetLevels().back()),
          _rowsOf(far_ext::InvertOrder(_graph.vertices)),
          _kind(kind),
          _deltas(deltas),
          _options(options) {
        auto const areas = far_ext::FindVertexAreas(_level, start);
        for (Index row = 0; row < _graph.numUnknowns; ++row) {
            Index const vertex = _graph.vertices[row];
            _roots.push_back(std::sqrt(areas[vertex]));
            _scale += areas[vertex] * Eigen::Vector3d(_deltas[vertex]).squaredNorm();
        }
        for (auto* rows : {&_preconditioned, &_moved, &_changed, &_factors, &_gradient})
            rows->assign(_graph.GetNumRows(), DoubleLanes::Zero());
    }

    Misfit Measure(std::span<double const> positions) const;
    double FindRelativeSize(Misfit const& misfit) const {
        return _scale > 0.0 ? std::sqrt(misfit.squares / _scale) : 0.0;
    }

    /// The misfit of moved positions; infinite where they have no Laplacian.
    Misfit TryMove(std::span<double const> positions, LaneRows const& step,
                   std::vector<double>& moved) const;

    void Linearise(std::span<double const> positions, Misfit const& misfit);

    struct Step {
        LaneRows move;
        double squares;  // of the misfit after it, were the problem linear
    };
    Step FindStep(double damping);

    int GetNumIterations() const { return _numIterations; }

private:
    void Apply(LaneRows const& coefficients, LaneRows& change);
    void ApplyTransposed(LaneRows const& misfit, LaneRows& coefficients);

    Far::TopologyRefiner const& _refiner;
    Far::TopologyLevel _level;
    Multigrid& _multigrid;
    MultigridLevel const& _graph;
    far_ext::LargeArray<Index> _rowsOf;  // per vertex
    AreaLaplacianKind _kind;
    far_ext::Points _deltas;
    AreaFitOptions const& _options;
    std::vector<double> _roots;  // per unknown: of the area it started with
    double _scale = 0.0;         // sum of squares of roots * Delta
    int _numIterations = 0;

    // Of the linearisation.
    Misfit const* _misfit = nullptr;
    std::unique_ptr<LaplacianDerivative> _derivative;
    std::vector<double> _balance;  // per unknown: makes the derivative's diagonal about -1
    LaneRows _preconditioned, _moved, _changed, _factors, _gradient;  // work; 0 at fixed rows
};

Misfit AreaFit::Measure(std::span<double const> positions) const {
    bool const isHeat = _kind == AreaLaplacianKind::Heat;
    Misfit misfit;
    misfit.laplacian = isHeat ? far_ext::BuildHeatLaplacian(_level, positions, &misfit.kernel)
                              : far_ext::BuildCotangentLaplacian(_level, positions);
    auto const images = far_ext::FindDeltas(misfit.laplacian.rows, positions);
    misfit.areas = isHeat ? far_ext::FindVertexAreas(_level, positions) : misfit.laplacian.areas;
    misfit.values.assign(_graph.GetNumRows(), DoubleLanes::Zero());
    misfit.byAreas = misfit.values;
    misfit.byImages.resize(_graph.numUnknowns);
    ForEachRow(_graph.numUnknowns, [&](Index row) {
        Index const vertex = _graph.vertices[row];
        double const root = _roots[row], scale = misfit.laplacian.areas[vertex];
        Eigen::Vector3d const found = far_ext::Points(images)[vertex] / scale;
        misfit.values[row] << (root * (_deltas[vertex] - found)).array(), 0.0;
        misfit.byImages[row] = -root / scale;
        if (!isHeat) misfit.byAreas[row] << (root / scale * found).array(), 0.0;
    });
    misfit.squares = SumSquares(misfit.values);
    return misfit;
}

Misfit AreaFit::TryMove(std::span<double const> positions, LaneRows const& step,
                        std::vector<double>& moved) const {
    moved.assign(positions.begin(), positions.end());
    far_ext::MutablePoints const points(moved);
    for (Index row = 0; row < _graph.numUnknowns; ++row)
        points[_graph.vertices[row]] += step[row].head<3>().matrix();
    try {
        return Measure(moved);
    } catch (Error const&) {  // a triangle collapsed on the way
        return {};
    }
}

/// \param misfit  of these positions; kept by reference
void AreaFit::Linearise(std::span<double const> positions, Misfit const& misfit) {
    _misfit = &misfit;
    _balance.resize(_graph.numUnknowns);
    ForEachRow(_graph.numUnknowns, [&](Index row) {
        _balance[row] = misfit.areas[_graph.vertices[row]] / _roots[row];
    });
    _multigrid.SetWeights(_refiner, FindWeights(_refiner, positions));
    _derivative =
        _kind == AreaLaplacianKind::Heat
            ? DifferentiateHeat(_level, _graph, _rowsOf, positions, misfit.laplacian, misfit.kernel)
            : DifferentiateCotangents(_level, _graph, _rowsOf, positions);
}

/// What the move that belongs to coefficients, in _moved, does to the misfit. Its derivative is
/// about -root G / A, which multigrid and the rest cancel.
void AreaFit::Apply(LaneRows const& coefficients, LaneRows& change) {
    if (_options.onWork) _options.onWork();
    ForEachRow(_graph.numUnknowns,
               [&](Index row) { _preconditioned[row] = _balance[row] * coefficients[row]; });
    _multigrid.Precondition(_preconditioned, _moved);
    _derivative->Apply(_moved, _changed);
    ForEachRow(_graph.numUnknowns, [&](Index row) {
        change[row] =
            _misfit->byImages[row] * _changed[row] + _changed[row][3] * _misfit->byAreas[row];
        change[row][3] = 0.0;
    });
}

void AreaFit::ApplyTransposed(LaneRows const& misfit, LaneRows& coefficients) {
    ForEachRow(_graph.numUnknowns, [&](Index row) {
        _factors[row] = _misfit->byImages[row] * misfit[row];
        _factors[row][3] = (misfit[row] * _misfit->byAreas[row]).sum();
    });
    _derivative->ApplyTransposed(_factors, _gradient);
    _multigrid.Precondition(_gradient, _preconditioned);
    ForEachRow(_graph.numUnknowns,
               [&](Index row) { coefficients[row] = _balance[row] * _preconditioned[row]; });
}

/// The step whose coefficients c minimise |misfit + change(c)|^2 + damping |c|^2, by conjugate
/// gradients for least squares.
AreaFit::Step AreaFit::FindStep(double damping) {
    // The step is as near as linearisation is worth: twice as near costs more than it gains.
    constexpr int kMaxIterations = 100;
    constexpr double kEnough = 0.1;  // of the gradient
    LaneRows zero(_graph.GetNumRows(), DoubleLanes::Zero());
    LaneRows rest = _misfit->values, coefficients = zero, gradient = zero, change = zero;
    Step step{zero, 0.0};
    ApplyTransposed(rest, gradient);
    LaneRows direction = gradient;
    double squares = SumSquares(gradient);
    double const goal = kEnough * kEnough * squares;
    for (int k = 0; k < kMaxIterations && squares > goal; ++k) {
        Apply(direction, change);
        double const share = -squares / (SumSquares(change) + damping * SumSquares(direction));
        ForEachRow(_graph.numUnknowns, [&](Index row) {
            coefficients[row] += share * direction[row];
            step.move[row] += share * _moved[row];
            rest[row] += share * change[row];
        });
        ApplyTransposed(rest, gradient);
        ForEachRow(_graph.numUnknowns,
                   [&](Index row) { gradient[row] += damping * coefficients[row]; });
        double const next = SumSquares(gradient);
        ForEachRow(_graph.numUnknowns, [&](Index row) {
            direction[row] = gradient[row] + next / squares * direction[row];
        });
        squares = next;
        ++_numIterations;
    }
    _multigrid.HoldAnchors(step.move);
    step.squares = SumSquares(rest);
    return step;
}

/// Nielsen's rule: damping falls where steps do what their linearisation says, and grows, faster
/// and faster, where they gain nothing at all.
class Damping {
public:
    double Get() const { return _value; }
    bool IsAtMost() const { return _value > 1e8; }  // moves are nothing there

    /// \param ratio  what a step gained over what it was to gain
    void Adapt(double ratio) {
        _value = std::max(1e-8, _value * std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * ratio - 1.0, 3)));
        _growth = 2.0;
    }

    void Raise() {
        _value *= _growth;
        _growth *= 2.0;
    }

private:
    double _value = 0.1, _growth = 2.0;
};

/// Whether the last steps gained little: three less than 2 %. Hundreds more would gain a tenth to
/// four tenths, by thinner triangles.
bool HasStalled(std::vector<double> const& residuals) {
    constexpr size_t kSteps = 3;
    size_t const last = residuals.size() - 1;
    return last >= kSteps && residuals[last] > 0.98 * residuals[last - kSteps];
}

}  // namespace

AreaFitReport FitAreaLaplacian(Far::TopologyRefiner const& refiner, Multigrid& multigrid,
                               AreaLaplacianKind kind, std::span<double const> deltas,
                               std::span<double> positions, AreaFitOptions const& options) {
    AreaFit fit(refiner, multigrid, kind, deltas, positions, options);
    AreaFitReport report;
    Misfit misfit = fit.Measure(positions);
    std::vector<double> residuals{fit.FindRelativeSize(misfit)};
    Damping damping;
    std::vector<double> moved;
    report.converged = residuals.back() <= options.tolerance;
    while (!report.converged && !report.hasStalled && report.steps < options.maxSteps) {
        fit.Linearise(positions, misfit);
        for (bool isTaken = false; !isTaken && !damping.IsAtMost();) {
            auto const step = fit.FindStep(damping.Get());
            Misfit next = fit.TryMove(positions, step.move, moved);
            isTaken = next.squares < misfit.squares;
            if (!isTaken) {
                damping.Raise();
                continue;
            }
            damping.Adapt((misfit.squares - next.squares) / (misfit.squares - step.squares));
            std::copy(moved.begin(), moved.end(), positions.begin());
            misfit = std::move(next);
        }
        residuals.push_back(fit.FindRelativeSize(misfit));
        report.converged = residuals.back() <= options.tolerance;
        report.hasStalled = damping.IsAtMost() || HasStalled(residuals);
        ++report.steps;
    }
    report.initialResidual = residuals.front();
    report.residual = residuals.back();
    report.iterations = fit.GetNumIterations();
    return report;
}

}  // namespace limn::eval
