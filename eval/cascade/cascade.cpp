// SPDX-License-Identifier: Apache-2.0
#include "eval/cascade/cascade.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <type_traits>

#include <fmt/format.h>

#include "eval/cascade/feature_filter.h"
#include "eval/parallel/rows.h"
#include "far_ext/error.h"
#include "far_ext/rows/points.h"

namespace limn::eval {

namespace {

using far_ext::CascadeLevel;

/// What positions and widths may be: the product of two squares has to fit into Scalar, in double
/// sums of sixth powers.
template <class Scalar>
constexpr double kLargestLength = std::is_same_v<Scalar, float> ? 1e9 : 1e48;

template <class Scalar>
void CheckLengths(std::span<double const> values, char const* what) {
    for (double value : values) {
        if (std::abs(value) <= kLargestLength<Scalar>) continue;
        throw Error(ErrorCode::BadMesh,
                    fmt::format("Cascade: {} of {}; they must be numbers up to {}", what, value,
                                kLargestLength<Scalar>));
    }
}

constexpr double kLeastAngleRadians = 3.14159265358979323846 / 180.0, kLeastAreaRatio = 1e-8;
constexpr double kLeastAreaLeft =
    1e-12;  // of the start mesh': what is smaller has a shape of rounding

template <class Scalar>
CascadeRows<Scalar> FindMeans(CascadeLevel const& level, CascadeRows<Scalar> const& coarse) {
    CascadeRows<Scalar> fine(level.vertices.size());
    ForEachRow(level.GetNumRows(), [&](Index row) {
        int const begin = level.parentOffsets[row], end = level.parentOffsets[row + 1];
        CascadeRow<Scalar> sum = coarse[level.parents[begin]];
        for (int k = begin + 1; k < end; ++k) sum += coarse[level.parents[k]];
        fine[row] =
            end - begin == 1 ? sum : CascadeRow<Scalar>(sum / static_cast<Scalar>(end - begin));
    });
    return fine;
}

template <class Scalar>
bool IsMoved(CascadeLevel const& level, CascadeOperator<Scalar> const& op, Index row) {
    return row < level.numUnknowns && op.diagonals[row] != Scalar(0);
}

/// What nothing moves, is where it was from the start.
template <class Scalar>
void ReturnUnmovedRows(CascadeLevel const& level, CascadeOperator<Scalar> const& op,
                       CascadeRows<Scalar> const& x0, CascadeRows<Scalar>& x) {
    ForEachRow(level.GetNumRows(), [&](Index row) {
        if (!IsMoved(level, op, row)) x[row] = x0[row];
    });
}

/// Whether ReturnUnmovedRows would change anything.
template <class Scalar>
bool IsAnyElsewhere(CascadeLevel const& level, CascadeOperator<Scalar> const& op,
                    CascadeRows<Scalar> const& x0, CascadeRows<Scalar> const& x) {
    std::atomic<bool> isAny = false;
    ForEachRow(level.GetNumRows(), [&](Index row) {
        if (!IsMoved(level, op, row) && (x[row] != x0[row]).any())
            isAny.store(true, std::memory_order_relaxed);
    });
    return isAny;
}

}  // namespace

template <class Scalar>
Cascade<Scalar>::Cascade(std::span<double const> positions, std::span<double const> widths,
                         CascadeOptions const& options)
    : _options(options) {
    bool const isLocal = options.width < 0.0;
    if (isLocal != (widths.size() * 3 == positions.size()) && !positions.empty()) {
        throw Error(ErrorCode::BadOption, "Cascade: give a width for all, or one per vertex");
    }
    if (std::is_same_v<Scalar, float> && options.solver != CascadeSolver::Jacobi) {
        throw Error(ErrorCode::BadOption,
                    "Cascade: in single precision only Jacobi sweeps are done");
    }
    if (options.solver == CascadeSolver::Jacobi && (options.order != 2 || options.features)) {
        throw Error(ErrorCode::BadOption,
                    "Cascade: Jacobi sweeps are of order 2 and keep no features");
    }
    if (options.evaluator) {
        if (std::is_same_v<Scalar, float> || options.solver != CascadeSolver::Jacobi) {
            throw Error(ErrorCode::BadOption,
                        "Cascade: an evaluator is for Jacobi sweeps of a cascade in double");
        }
        _tables.emplace(*options.evaluator);
    }
    CheckLengths<Scalar>(positions, "a coordinate");
    CheckLengths<Scalar>(isLocal ? widths : std::span(&options.width, 1), "a width");
    for (size_t i = 0; i < positions.size() / 3; ++i) {
        Scalar const h = isLocal ? static_cast<Scalar>(widths[i]) : Scalar(0);
        auto const at = [&](size_t c) { return static_cast<Scalar>(positions[3 * i + c]); };
        if (options.isGraph) {
            _x0.emplace_back(Scalar(0), Scalar(0), at(2), h);
            _plane.emplace_back(at(0), at(1), Scalar(0), h);
        } else {
            _x0.emplace_back(at(0), at(1), at(2), h);
        }
    }
    _x = _x0;
}

template <class Scalar>
bool Cascade<Scalar>::IsDegenerate(MetricQuality const& quality) const {
    return !(quality.minAngleRadians >= _leastAngle && quality.areaRatio >= _leastAreaRatio &&
             quality.area >= kLeastAreaLeft * _startArea);
}

/// From the coarser level to this one.
template <class Scalar>
CascadeRows<Scalar> Cascade<Scalar>::Prolong(CascadeRows<Scalar> const& coarse) const {
    if constexpr (std::is_same_v<Scalar, double>) {
        if (_tables) return _tables->Prolong(coarse);
    }
    return FindMeans(*_level, coarse);
}

template <class Scalar>
CascadeStepReport Cascade<Scalar>::Step(CascadeLevel const& level, int iterations,
                                        std::span<double const> givenWidths) {
    _level = &level;
    if (_tables) _tables->SetLevel(level, static_cast<Index>(_x.size()));
    _x0 = Prolong(_x0);
    _x = Prolong(_x);
    if (_options.isGraph) _plane = Prolong(_plane);
    if (_isFrozen) _metric = Prolong(_metric);
    _hasGivenWidths = !givenWidths.empty();
    for (size_t row = 0; _hasGivenWidths && row < _x.size(); ++row) {
        _x[row][3] = _x0[row][3] = static_cast<Scalar>(givenWidths[level.vertices[row]]);
        if (_options.isGraph) _plane[row][3] = _x0[row][3];
    }
    return Repeat(iterations);
}

template <class Scalar>
CascadeStepReport Cascade<Scalar>::Repeat(int iterations) {
    CascadeStepReport const report = Solve(iterations);
    if (_options.width < 0.0) {
        ForEachRow(_level->GetNumRows(), [&](Index row) {
            if (_hasGivenWidths || _x0[row][3] == Scalar(0)) _x[row][3] = _x0[row][3];
        });
    }
    return report;
}

template <class Scalar>
CascadeStepReport Cascade<Scalar>::Solve(int iterations) {
    CascadeLevel const& level = *_level;
    CascadeStepReport report;
    report.unknowns = level.numUnknowns;
    Scalar const width = static_cast<Scalar>(_options.width);
    CascadeRows<Scalar>& present = _options.isGraph ? _plane : _x;
    if (_options.isGraph) {  // the plane's metric, with the widths as they are now
        for (size_t row = 0; row < _x.size(); ++row) present[row][3] = _x[row][3];
    }
    MetricQuality const quality = BuildOperator(level, present, width, _operator);
    if (_leastAngle < 0.0) {  // the first metric is that of the start mesh
        _leastAngle = std::min(kLeastAngleRadians, quality.minAngleRadians / 2);
        _leastAreaRatio = std::min(kLeastAreaRatio, quality.areaRatio / 4);
        _startArea = quality.area;
    }
    report.minAngleRadians = quality.minAngleRadians;
    report.areaRatio = quality.areaRatio;
    if (!_isFrozen && IsDegenerate(quality)) {
        _isFrozen = true;
        if (_metric.empty()) _metric = present;  // there is no coarser level
        if (_metric.size() != _x.size())
            _metric = Prolong(_metric);  // it is still the coarser level's
    }
    report.isMetricFrozen = _isFrozen;
    if (_isFrozen) {
        for (size_t row = 0; row < _x.size(); ++row) _metric[row][3] = _x[row][3];
        BuildOperator(level, _metric, width, _operator);
    }
    BuildEquation(_isFrozen ? _metric : present, iterations);

    if (_options.solver == CascadeSolver::Jacobi) {
        Sweep(iterations);
        report.sweeps = iterations;
        report.residual = _options.measuresResidual ? MeasureResidual(level, _operator, _x, _x0)
                                                    : std::numeric_limits<double>::quiet_NaN();
        return report;
    }
    if (!_isFrozen) _metric = present;
    ReturnUnmovedRows(level, _operator, _x0, _x);
    CascadeSolve const solve = SolveRows(_operator, _x0, _x, iterations);
    report.sweeps = solve.iterations;
    report.residual = solve.residual;
    report.converged =
        solve.converged || _options.tolerance == 0.0;  // a count was asked for, and done
    return report;
}

/// From the plain operator of a metric to the one that is asked for.
template <class Scalar>
void Cascade<Scalar>::BuildEquation(CascadeRows<Scalar> const& metric, int iterations) {
    _operator.order = _options.order;
    if constexpr (std::is_same_v<Scalar, double>) {
        if (_tables) _tables->SetOperator(*_level, _operator);
        if (!_options.features) return;
        auto const& [lambda, normalsWidth] = *_options.features;
        CascadeOperator<double> plain;
        BuildOperator(*_level, metric, normalsWidth, plain);
        CascadeRows<double> smooth = metric;
        SolveRows(plain, metric, smooth, iterations);
        KeepFeatures(*_level, metric, FindRowNormals(*_level, smooth), _options.width, lambda,
                     _operator);
    }
}

/// By one of the solvers that are no sweeps; in single precision there is none.
template <class Scalar>
CascadeSolve Cascade<Scalar>::SolveRows(CascadeOperator<Scalar> const& op,
                                        CascadeRows<Scalar> const& x0, CascadeRows<Scalar>& x,
                                        int iterations) const {
    if constexpr (std::is_same_v<Scalar, double>) {
        return _options.solver == CascadeSolver::Exact
                   ? SolveByCholesky(*_level, op, x0, x)
                   : SolveByConjugateGradients(*_level, op, x0, x, iterations, _options.tolerance,
                                               _options.progress);
    }
    return {};
}

template <class Scalar>
void Cascade<Scalar>::Sweep(int iterations) {
    CascadeLevel const& level = *_level;
    if (_tables) {
        if (!_isFrozen) _metric = _options.isGraph ? _plane : _x;
        ReturnUnmovedRows(level, _operator, _x0, _x);
        return SweepByTables(_x0, _x, iterations);
    }
    CascadeRows<Scalar> const* from = &_x;
    if (!_isFrozen && !_options.isGraph && iterations > 0 &&
        !IsAnyElsewhere(level, _operator, _x0, _x)) {
        _metric.swap(
            _x);  // the surface as it is now is the metric, and sweeps have two other buffers
        from = &_metric;
    } else {
        if (!_isFrozen) _metric = _options.isGraph ? _plane : _x;
        ReturnUnmovedRows(level, _operator, _x0, _x);
    }
    for (CascadeRows<Scalar>* rows : {&_x, &_next}) {
        if (rows->size() != _x0.size()) *rows = CascadeRows<Scalar>(_x0.size());
        std::copy(_x0.begin() + level.numUnknowns, _x0.end(), rows->begin() + level.numUnknowns);
    }
    SweepInParts(*from, _x0, _next, _x, iterations);
}

template <class Scalar>
void Cascade<Scalar>::SweepByTables(CascadeRows<Scalar> const& x0, CascadeRows<Scalar>& x,
                                    int iterations) const {
    if constexpr (std::is_same_v<Scalar, double>) {
        _tables->Sweep(x0, x, iterations, _options.progress);
        ReturnUnmovedRows(*_level, _operator, x0, x);  // which were rounded
    }
}

/// From `from` to x, with `next` as the other buffer; so many at once that telling of them costs
/// nothing.
template <class Scalar>
void Cascade<Scalar>::SweepInParts(CascadeRows<Scalar> const& from, CascadeRows<Scalar> const& x0,
                                   CascadeRows<Scalar>& next, CascadeRows<Scalar>& x,
                                   int iterations) const {
    constexpr int kPart = 64;
    for (int done = 0; done < iterations; done += kPart) {
        if (_options.progress) _options.progress(static_cast<double>(done) / iterations);
        int const count = std::min(kPart, iterations - done);
        SweepJacobi(*_level, _operator, done == 0 ? from : x, x0, next, x, count);
        if (count % 2 == 1) x.swap(next);
    }
}

template <class Scalar>
std::vector<double> Cascade<Scalar>::GetPublic(CascadeRows<Scalar> const& rows) const {
    std::vector<double> values(3 * rows.size());
    far_ext::MutablePoints const points(values);
    for (size_t row = 0; row < rows.size(); ++row) {
        auto point = points[GetVertex(row)];
        for (Eigen::Index c = 0; c < 3; ++c) {
            bool const isInPlane = _options.isGraph && c < 2;
            point[c] = static_cast<double>(isInPlane ? _plane[row][c] : rows[row][c]);
        }
    }
    return values;
}

template <class Scalar>
std::vector<double> Cascade<Scalar>::GetPositions() const {
    return GetPublic(_x);
}

template <class Scalar>
std::vector<double> Cascade<Scalar>::GetStartPositions() const {
    return GetPublic(_x0);
}

template <class Scalar>
std::vector<double> Cascade<Scalar>::GetWidths() const {
    std::vector<double> widths(_x.size(), _options.width);
    for (size_t row = 0; _options.width < 0.0 && row < _x.size(); ++row)
        widths[GetVertex(row)] = static_cast<double>(_x[row][3]);
    return widths;
}

template <class Scalar>
CascadeRows<Scalar> Cascade<Scalar>::MakeRows(std::span<double const> values) const {
    CascadeRows<Scalar> rows;
    rows.reserve(_x.size());
    far_ext::Points const points(values);
    for (size_t row = 0; row < _x.size(); ++row) {
        auto const value = points[GetVertex(row)];
        rows.emplace_back(static_cast<Scalar>(value[0]), static_cast<Scalar>(value[1]),
                          static_cast<Scalar>(value[2]), Scalar(0));
    }
    return rows;
}

template <class Scalar>
std::vector<double> Cascade<Scalar>::Filter(std::span<double const> values, int iterations) const {
    CascadeRows<Scalar> const y0 = MakeRows(values);
    CascadeRows<Scalar> y = y0;
    if (_tables) {
        SweepByTables(y0, y, iterations);
    } else if (_options.solver == CascadeSolver::Jacobi) {
        CascadeRows<Scalar> next = y0;
        SweepInParts(y0, y0, next, y, iterations);
    } else {
        SolveRows(_operator, y0, y, iterations);
    }
    return GetPublic(y);
}

template <class Scalar>
void Cascade<Scalar>::SetPositions(std::span<double const> positions) {
    CascadeRows<Scalar> const rows = MakeRows(positions);
    ForEachRow(static_cast<Index>(_x.size()),
               [&](Index row) { _x[row].template head<3>() = rows[row].template head<3>(); });
}

template class Cascade<float>;
template class Cascade<double>;

int CountSweeps(CascadeSolver solver, int finest, int levelsLeft, bool isBisection) {
    double const exponent =
        (solver == CascadeSolver::Jacobi ? 2.0 : 1.5) * (isBisection ? 0.5 : 1.0);
    return static_cast<int>(
        std::min(1e6, std::ceil(finest * std::exp2(exponent * levelsLeft) - 1e-9)));
}

}  // namespace limn::eval
