// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "eval/fit/step_schedule.h"
#include "eval/parallel/rows.h"

namespace limn::eval {

namespace {

/// E = a E + b R, P += E, R -= A E: the table meets steps alone, so that what floats lose of them
/// shrinks as they do. R is found anew, by A in double, once it is small enough.
class TableIteration {
public:
    TableIteration(LimitProblem const& problem, StationaryMethod method, double lambda,
                   double smallest)
        : _problem(problem),
          _method(method),
          _schedule(method, lambda),
          _smallest(smallest),
          _residual(static_cast<size_t>(problem.A.GetNumVertices()) * problem.length, 0.0),
          _step(_residual),
          _product(_residual) {}

    IterationResult Run() {
        double before = std::numeric_limits<double>::infinity();
        while (true) {
            double const residual = FindResiduals();
            if (!IsUsedUp()) Record(residual);
            _result.residual = residual;
            _result.converged = residual <= _problem.tolerance;
            // Not even half: rounding, or divergence.
            _result.isStuck |= !_result.converged && !(residual < 0.5 * before);
            if (_result.converged || _result.isStuck || IsUsedUp()) break;
            before = residual;
            Correct(residual);
        }
        _result.lambdaMin = _method == StationaryMethod::Progressive ? 0.0 : _schedule.GetLambda();
        return std::move(_result);
    }

private:
    using Stage = LimitOperator::Stage;

    bool IsUsedUp() const { return _result.applications >= _problem.maxApplications; }

    void Record(double residual) {
        ++_result.applications;
        _result.history.push_back(residual);
        if (_problem.onIteration) _problem.onIteration(_result.applications, residual);
    }

    /// The largest length of rows of the rest that visit(number) has come by; NaN where one has.
    template <class Visit>
    double FindLargest(Visit const& visit) {
        auto const maxima =
            MapBlocks(_problem.A.GetNumVertices(), kRowsPerSum, [&](Index begin, Index end) {
                double largest = 0.0;
                for (Index row = begin; row < end; ++row) {
                    if (_problem.A.GetClass(row).stage != Stage::Rest) continue;
                    double square = 0.0;
                    for (size_t k = GetFirst(row); k < GetFirst(row + 1); ++k) {
                        double const value = visit(k);
                        square += value * value;
                    }
                    if (!(square <= largest)) largest = square;
                }
                return largest;
            });
        double largest = 0.0;
        for (double const square : maxima) {
            if (!(square <= largest)) largest = square;
        }
        return std::sqrt(largest) / _problem.size;
    }

    size_t GetFirst(Index row) const { return static_cast<size_t>(row) * _problem.length; }

    /// R = M - A P in double.
    double FindResiduals() {
        size_t const count = _residual.size();
        _problem.A.Apply({_problem.solution, count}, _problem.length, _product);
        return FindLargest([&](size_t k) { return _residual[k] = _problem.data[k] - _product[k]; });
    }

    double TakeStep() {
        double a = 0.0, b = 0.0;
        _schedule.Advance(a, b);
        ForEachRow(_problem.A.GetNumVertices(), [&](Index row) {
            for (size_t k = GetFirst(row); k < GetFirst(row + 1); ++k) {
                _step[k] = a * _step[k] + b * _residual[k];
                _problem.solution[k] += _step[k];
            }
        });
        _problem.table->Apply(_step, _problem.length, _product);
        return FindLargest([&](size_t k) { return _residual[k] -= _product[k]; });
    }

    void Correct(double start) {
        constexpr double kMostGrown = 1e4;
        double const goal = 0.9 * _problem.tolerance;
        while (!IsUsedUp()) {
            double const residual = TakeStep();
            Record(residual);
            _watch.Add(residual);
            if (residual <= goal || !(residual < kMostGrown * start)) return;
            if (_method != StationaryMethod::Chebyshev || !_watch.IsReady()) continue;
            _result.isStuck = !LowerBound(_schedule, _watch, _smallest);
            if (_result.isStuck) return;
        }
    }

    LimitProblem const& _problem;
    StationaryMethod _method;
    StepSchedule _schedule;
    double _smallest;
    std::vector<double> _residual, _step, _product;  // R and E are 0 beside the rest
    RateWatch _watch;
    IterationResult _result;
};

}  // namespace

IterationResult RunByTable(LimitProblem const& problem, StationaryMethod method, double lambda,
                           double smallest) {
    return TableIteration(problem, method, lambda, smallest).Run();
}

}  // namespace limn::eval
