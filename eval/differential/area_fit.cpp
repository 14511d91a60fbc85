// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/area_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "far_ext/error.h"
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

/// Where Delta is missed: Delta - A^-1 L V, 0 at fixed vertices.
struct Misfit {
    std::vector<double> values, areas;  ///< 3 and 1 per vertex
    double squares = 0.0,
           scale = 0.0;  ///< area-weighted sums of squares: of the misfit, and of Delta
};

/// The least-squares problem and its linearisation. Norms are weighted by area: they mean the same
/// on every mesh of the surface, and thin triangles do not rule [Differential 6].
class AreaFit {
public:
    AreaFit(Far::TopologyRefiner const& refiner, Multigrid& multigrid,
            LaplacianBuilder const& build, std::span<double const> deltas)
        : _refiner(refiner),
          _multigrid(multigrid),
          _finest(multigrid.GetLevels().back()),
          _build(build),
          _deltas(deltas) {}

    Misfit Measure(std::span<double const> positions) const {
        auto const laplacian = _build(positions);
        Misfit misfit{std::vector<double>(positions.size()), laplacian.areas};
        laplacian.rows.Apply(positions.data(), misfit.values.data(), 3);
        far_ext::Points const deltas(_deltas);
        far_ext::MutablePoints const values(misfit.values);
        for (Index row = 0; row < _finest.GetNumRows(); ++row) {
            Index const vertex = _finest.vertices[row];
            double const area = laplacian.areas[vertex];
            bool const isUnknown = row < _finest.numUnknowns;
            for (Index c = 0; c < 3; ++c) {
                double const delta = deltas[vertex][c];
                double& value = values[vertex][c];
                value = isUnknown ? delta - value / area : 0.0;
                misfit.squares += area * value * value;
                if (isUnknown) misfit.scale += area * delta * delta;
            }
        }
        return misfit;
    }

    /// The misfit of moved positions; its squares are not a number where they have no Laplacian.
    Misfit TryMove(std::span<double const> positions, std::vector<double> const& step, double share,
                   std::vector<double>& moved) const {
        moved.assign(positions.begin(), positions.end());
        for (size_t i = 0; i < moved.size(); ++i) moved[i] += share * step[i];
        try {
            return Measure(moved);
        } catch (Error const&) {  // a triangle collapsed on the way
            Misfit none;
            none.squares = std::nan("");
            return none;
        }
    }

    std::vector<double> FindStep(std::span<double const> positions, Misfit const& misfit);

    int GetNumIterations() const { return _numIterations; }

private:
    double Product(std::vector<double> const& a, std::vector<double> const& b,
                   Misfit const& misfit) const {
        double sum = 0.0;
        for (size_t i = 0; i < a.size(); ++i) sum += misfit.areas[i / 3] * a[i] * b[i];
        return sum;
    }

    Far::TopologyRefiner const& _refiner;
    Multigrid& _multigrid;
    MultigridLevel const& _finest;
    LaplacianBuilder const& _build;
    std::span<double const> _deltas;
    int _numIterations = 0;
};

double FindLargest(std::span<double const> values) {
    double largest = 0.0;
    for (double value : values) largest = std::max(largest, std::abs(value));
    return largest;
}

/// The greatest extent along an axis.
double FindExtent(std::span<double const> positions) {
    double extent = 0.0;
    for (size_t c = 0; c < 3; ++c) {
        double low = positions[c], high = positions[c];
        for (size_t i = c; i < positions.size(); i += 3) {
            low = std::min(low, positions[i]);
            high = std::max(high, positions[i]);
        }
        extent = std::max(extent, high - low);
    }
    return extent;
}

void AddTimes(std::vector<double>& to, double factor, std::vector<double> const& values) {
    for (size_t i = 0; i < to.size(); ++i) to[i] += factor * values[i];
}

/// The move that minimises |misfit - J move|, J z = (misfit(V) - misfit(V + e z)) / e, over a
/// Krylov space: flexible GMRES, since the multigrid is not quite the same map twice. J^T is not
/// needed, as it would be for normal equations [Differential 6].
std::vector<double> AreaFit::FindStep(std::span<double const> positions, Misfit const& misfit) {
    constexpr int kMaxDimension = 12;
    constexpr double kEnough = 0.05;  // of the misfit: farther than linearisation reaches
    _multigrid.SetWeights(_refiner, FindWeights(_refiner, positions));
    // Moves are kept beside the basis: the step is made of them, not of what went into them.
    double const size = std::sqrt(misfit.squares), extent = FindExtent(positions);
    std::vector<std::vector<double>> basis{misfit.values}, moves;
    for (double& value : basis[0]) value /= size;
    Eigen::MatrixXd hessenberg = Eigen::MatrixXd::Zero(kMaxDimension + 1, kMaxDimension);
    Eigen::VectorXd weights;
    std::vector<double> moved;
    for (int k = 0; k < kMaxDimension; ++k) {
        // The move that the Laplacian of the present angles would answer this misfit with.
        std::vector<double> rightSide = basis[k], move(positions.size(), 0.0);
        for (size_t i = 0; i < rightSide.size(); ++i) rightSide[i] *= misfit.areas[i / 3];
        _numIterations +=
            _multigrid.Solve(rightSide, move, {.tolerance = 1e-2, .maxIterations = 20}).iterations;
        // A difference small enough to be a derivative, large enough to be no rounding.
        double const length = FindLargest(move),
                     share = length > 0.0 ? 1e-6 * extent / length : 1.0;
        Misfit const there = TryMove(positions, move, share, moved);
        if (!std::isfinite(there.squares)) break;
        std::vector<double> image = misfit.values;
        AddTimes(image, -1.0, there.values);
        for (double& value : image) value /= share;
        for (int j = 0; j <= k; ++j) {
            hessenberg(j, k) = Product(image, basis[j], misfit);
            AddTimes(image, -hessenberg(j, k), basis[j]);
        }
        hessenberg(k + 1, k) = std::sqrt(Product(image, image, misfit));
        moves.push_back(std::move(move));
        Eigen::MatrixXd const part = hessenberg.topLeftCorner(k + 2, k + 1);
        Eigen::VectorXd const first = Eigen::VectorXd::Unit(k + 2, 0) * size;
        weights = part.colPivHouseholderQr().solve(first);
        if ((first - part * weights).norm() < kEnough * size || !(hessenberg(k + 1, k) > 0.0))
            break;
        for (double& value : image) value /= hessenberg(k + 1, k);
        basis.push_back(std::move(image));
    }
    std::vector<double> step(positions.size(), 0.0);
    for (size_t k = 0; k < moves.size(); ++k)
        AddTimes(step, weights[static_cast<Index>(k)], moves[k]);
    return step;
}

}  // namespace

AreaFitReport FitAreaLaplacian(Far::TopologyRefiner const& refiner, Multigrid& multigrid,
                               LaplacianBuilder const& build, std::span<double const> deltas,
                               std::span<double> positions, AreaFitOptions const& options) {
    AreaFit fit(refiner, multigrid, build, deltas);
    AreaFitReport report;
    Misfit misfit = fit.Measure(positions);
    auto const relative = [&] {
        return misfit.scale > 0.0 ? std::sqrt(misfit.squares / misfit.scale) : 0.0;
    };
    report.residual = report.initialResidual = relative();
    report.converged = report.residual <= options.tolerance;
    std::vector<double> moved;
    while (!report.converged && report.steps < options.maxSteps) {
        std::vector<double> const step = fit.FindStep(positions, misfit);
        // Halving stands in for damping: the first share that lowers the sum is taken.
        double share = 1.0;
        Misfit next = fit.TryMove(positions, step, share, moved);
        while (!(next.squares < misfit.squares) && share > 1.0 / 64)
            next = fit.TryMove(positions, step, share *= 0.5, moved);
        ++report.steps;
        double const last = report.residual;
        if (next.squares < misfit.squares) {
            std::copy(moved.begin(), moved.end(), positions.begin());
            misfit = std::move(next);
        }
        report.residual = relative();
        // There may be no solution: what gains less than 1 % is as near as this gets.
        bool const isStill = share * FindLargest(step) < options.tolerance * FindExtent(positions);
        report.converged =
            report.residual <= options.tolerance || isStill || report.residual > 0.99 * last;
    }
    report.iterations = fit.GetNumIterations();
    return report;
}

}  // namespace limn::eval
