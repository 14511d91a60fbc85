// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "eval/fit/step_schedule.h"
#include "eval/parallel/step_pass.h"
#include "far_ext/rows/large_array.h"

namespace limn::eval {

namespace {

using Stage = LimitOperator::Stage;

/// The larger one, or the one that is no number: a residual that is none must be seen.
template <class Real>
Real Larger(Real value, Real largest) {
    return value <= largest || std::isnan(largest) ? largest : value;
}

template <class Real>
Real FindLargest(std::vector<Real> const& values) {
    Real largest = 0;
    for (Real value : values) largest = Larger(value, largest);
    return largest;
}

/// Coefficients of a step.
struct Step {
    float a, b;
};

/// The inner iteration, in float: a correction E with A E = R, started at 0, in the unit of the
/// data's size.
template <int Lanes>
class Correction {
public:
    explicit Correction(LimitOperator const& A)
        : _operator(A),
          _right(A.GetNumVertices() * Row::kStride, 0.0f),
          _current(_right),
          _previous(_right) {}

    int GetStepsPerPass() const {
        return CountStepsPerPass(_operator.GetNumVertices(), _operator.GetBandwidth());
    }

    /// Steps in place, with max |R - A E| from before each of them.
    std::vector<float> Take(std::span<Step const> steps) {
        if (steps.size() == 1) return {TakeOne(steps[0])};
        Index const numRows = _operator.GetNumVertices();
        size_t const numBlocks = CountBlocks(numRows, kRowsPerBlock);
        std::vector<std::vector<float>> maxima(steps.size(), std::vector<float>(numBlocks, 0.0f));
        float* const buffers[] = {_current.data(), _previous.data()};
        RunStepsInOnePass(static_cast<Index>(steps.size()), numRows, _operator.GetBandwidth(),
                          [&](Index step, Index begin, Index end) {
                              maxima[step][begin / kRowsPerBlock] =
                                  TakeRows(steps[step], begin, end, buffers[step % 2],
                                           buffers[(step + 1) % 2]);
                          });
        if (steps.size() % 2 == 1) std::swap(_current, _previous);
        std::vector<float> residuals;
        residuals.reserve(maxima.size());
        for (auto const& ofStep : maxima) residuals.push_back(std::sqrt(FindLargest(ofStep)));
        return residuals;
    }

    /// Starts again at E = 0 for another right side, with the memory kept: what was E_k becomes 0,
    /// and E_{k-1} is less by it. The step that follows needs no A.
    void Restart(double a, double b) {
        float const fa = static_cast<float>(a), fb = static_cast<float>(b);
        ForEachRow(_operator.GetNumVertices(), [&](Index row) {
            Row const before = Row::Load(_previous.data(), row) - Row::Load(_current.data(), row);
            (fb * Row::Load(_right.data(), row) - fa * before).Store(_previous.data(), row);
            Row().Store(_current.data(), row);
        });
        std::swap(_current, _previous);
    }

    float* GetRight() { return _right.data(); }
    float const* Get() const { return _current.data(); }
    static constexpr size_t kStride = FloatRow<Lanes>::kStride;

private:
    using Row = FloatRow<Lanes>;

    float TakeOne(Step step) {
        auto const maxima =
            MapBlocks(_operator.GetNumVertices(), kRowsPerSum, [&](Index begin, Index end) {
                return TakeRows(step, begin, end, _current.data(), _previous.data());
            });
        std::swap(_current, _previous);
        return std::sqrt(FindLargest(maxima));
    }

    /// Rows of a step from E_k to E_{k+1}, which takes the place of E_{k-1}. Returns max |R - A
    /// E_k|^2.
    float TakeRows(Step step, Index begin, Index end, float const* current, float* previous) const {
        float largest = 0.0f;
        _operator.ForEachRow<Row>(
            begin, end, Stage::Rest, current,
            [&](Index row, auto const&, Row const& own, Row const& limit) {
                Row const residual = Row::Load(_right.data(), row) - limit;
                largest = std::max(largest, residual.SquaredLength());
                (own + step.a * (own - Row::Load(previous, row)) + step.b * residual)
                    .Store(previous, row);
            });
        return largest;
    }

    LimitOperator const& _operator;
    far_ext::LargeArray<float> _right, _current,
        _previous;  // of vertices that are not of the rest: 0
};

/// The outer iteration, in double: R = M - A P, P += E until R is small enough.
template <int Length>
class StationarySolve {
public:
    StationarySolve(LimitProblem const& problem, StationaryMethod method, double lambda,
                    double smallest)
        : _problem(problem),
          _method(method),
          _schedule(method, lambda),
          _smallest(smallest),
          _correction(problem.A) {}

    IterationResult Run() {
        double before = 1e30;
        while (true) {
            double const residual = FindRight();
            if (!IsUsedUp()) Record(residual);
            _result.residual = residual;
            _result.converged = residual <= _problem.tolerance;
            // Not even half: rounding, divergence, or an eigenvalue that the inner steps cannot
            // see.
            _result.isStuck |= !_result.converged && !(residual < 0.5 * before);
            if (_result.converged || _result.isStuck || IsUsedUp()) break;
            before = residual;
            Correct(residual);
            AddCorrection();
        }
        _result.lambdaMin = _method == StationaryMethod::Progressive ? 0.0 : _schedule.GetLambda();
        return std::move(_result);
    }

private:
    static constexpr int kLanes = Length == 1 ? 1 : 4;
    /// So far inner steps go, as a share of the right side; rounding in float ends them at about a
    /// tenth of it.
    static constexpr double kInnerGain = 1e-5;

    bool IsUsedUp() const { return _result.applications >= _problem.maxApplications; }

    void Record(double residual) {
        ++_result.applications;
        _result.history.push_back(residual);
        if (_problem.onIteration) _problem.onIteration(_result.applications, residual);
    }

    /// The right side of the correction. Returns max |M - A P|.
    double FindRight() {
        using Row = DoubleRow<Length>;
        auto const maxima =
            MapBlocks(_problem.A.GetNumVertices(), kRowsPerSum, [&](Index begin, Index end) {
                double largest = 0.0;
                _problem.A.ForEachRow<Row>(
                    begin, end, Stage::Rest, _problem.solution,
                    [&](Index row, auto const&, Row const&, Row const& limit) {
                        Row const residual = Row::Load(_problem.data, row) - limit;
                        largest = Larger(residual.SquaredLength(), largest);
                        float* const right = _correction.GetRight() + row * _correction.kStride;
                        for (size_t i = 0; i < Length; ++i)
                            right[i] = static_cast<float>(residual.values[i] / _problem.size);
                    });
                return largest;
            });
        return std::sqrt(FindLargest(maxima)) / _problem.size;
    }

    void Correct(double start) {
        double const goal = std::max(0.9 * _problem.tolerance, kInnerGain * start);
        double a, b;
        _schedule.Advance(a, b);
        _correction.Restart(a, b);
        _watch.Add(start);
        double last = start, rate = _schedule.GetExpectedRate();
        while (!IsUsedUp()) {
            std::vector<Step> steps;
            for (int count = CountSteps(last, goal, rate); count > 0; --count) {
                _schedule.Advance(a, b);
                steps.push_back({static_cast<float>(a), static_cast<float>(b)});
            }
            bool isDone = false;
            for (float value : _correction.Take(steps)) {
                double const residual = static_cast<double>(value);
                Record(residual);
                isDone |= residual <= goal || !(residual < 1e4 * start);
                _watch.Add(residual);
                rate = residual / last;
                last = residual;
            }
            if (isDone) return;
            if (_method != StationaryMethod::Chebyshev || !_watch.IsReady()) continue;
            _result.isStuck = !LowerBound(_schedule, _watch, _smallest);
            if (_result.isStuck) return;
        }
    }

    /// Steps to take together: as many as are needed anyway, if a step goes on to shrink the
    /// residual by `rate`.
    int CountSteps(double last, double goal, double rate) const {
        int const most = std::min(_correction.GetStepsPerPass(),
                                  _problem.maxApplications - _result.applications);
        double const needed =
            rate > 0.0 && rate < 1.0 ? std::log(goal / last) / std::log(rate) : 1.0;
        return needed > 1.0 ? std::min(most, static_cast<int>(std::min(needed, 100.0))) : 1;
    }

    void AddCorrection() {
        ForEachRow(_problem.A.GetNumVertices(), [&](Index row) {
            float const* const e = _correction.Get() + row * _correction.kStride;
            double* const p = _problem.GetSolution(row);
            for (size_t i = 0; i < Length; ++i) p[i] += _problem.size * static_cast<double>(e[i]);
        });
    }

    LimitProblem const& _problem;
    StationaryMethod _method;
    StepSchedule _schedule;
    double _smallest;
    Correction<kLanes> _correction;
    RateWatch _watch;
    IterationResult _result;
};

}  // namespace

IterationResult RunStationary(LimitProblem const& problem, StationaryMethod method, double lambda,
                              double smallest) {
    if (problem.table) return RunByTable(problem, method, lambda, smallest);
    IterationResult result;
    WithLength(problem.length, [&]<int Length>() {
        result = StationarySolve<Length>(problem, method, lambda, smallest).Run();
    });
    return result;
}

double FindResidual(LimitProblem const& problem, Index* worst) {
    struct Largest {
        double square = -1.0;
        Index row = -1;
    };
    Largest largest;
    WithLength(problem.length, [&]<int Length>() {
        auto const maxima =
            MapBlocks(problem.A.GetNumVertices(), kRowsPerSum, [&](Index begin, Index end) {
                Largest found;
                using Row = DoubleRow<Length>;
                problem.A.ForEachRow<Row>(
                    begin, end, Stage::Fixed, problem.solution,
                    [&](Index row, auto const&, Row const&, Row const& limit) {
                        double const square =
                            (Row::Load(problem.data, row) - limit).SquaredLength();
                        if (!(square <= found.square)) found = {square, row};
                    });
                return found;
            });
        for (Largest const& found : maxima) {
            if (!(found.square <= largest.square)) largest = found;
        }
    });
    if (worst) *worst = largest.row;
    return std::sqrt(std::max(0.0, largest.square)) / problem.size;
}

}  // namespace limn::eval
