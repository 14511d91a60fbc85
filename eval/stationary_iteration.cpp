#include <algorithm>
#include <cmath>

#include "eval/limit_problem.h"

namespace limn::eval {

namespace {

using Stage = LimitOperator::Stage;

/// Coefficients a and b of the steps.
class Schedule {
public:
    Schedule(StationaryMethod method, double lambda) : _method(method) { Restart(lambda); }

    void Restart(double lambda) {
        _lambda = lambda;
        _theta = (1.0 + lambda) / 2.0;
        _sigma = _theta / ((1.0 - lambda) / 2.0);
        _rho = 0.0;
    }

    void Advance(double& a, double& b) {
        a = 0.0;
        b = 1.0;
        if (_method == StationaryMethod::Weighted) b = 1.0 / _theta;
        if (_method != StationaryMethod::Chebyshev) return;
        if (_rho == 0.0) {  // the first step
            _rho = 1.0 / _sigma;
            b = 1.0 / _theta;
            return;
        }
        double const rho = 1.0 / (2.0 * _sigma - _rho);
        a = rho * _rho;
        b = 2.0 * rho * _sigma / _theta;
        _rho = rho;
    }

    double GetLambda() const { return _lambda; }

    /// Chebyshev's factor per step, if the bound holds.
    double GetExpectedRate() const { return 1.0 / GetGrowth(_sigma); }

    /// The eigenvalue whose mode shrinks by `rate` per step; the bound was too high if that is slow.
    double FindEigenvalue(double rate) const {
        double const growth = rate * GetGrowth(_sigma);
        double const place = 0.5 * (growth + 1.0 / growth);
        return _theta - place * (1.0 - _lambda) / 2.0;
    }

private:
    static double GetGrowth(double x) { return x + std::sqrt(x * x - 1.0); }

    StationaryMethod _method;
    double _lambda = 0.0, _theta = 0.0, _sigma = 0.0, _rho = 0.0;
};

/// One step in place: `previous` becomes the next P. Returns max |M - A P|.
template <int Length>
double Step(LimitProblem const& problem, double const* current, double* previous, double a, double b) {
    auto const maxima = MapChunks(problem.A.GetNumVertices(), [&](Index begin, Index end) {
        double largest = 0.0;
        problem.A.ForEachRow<Length>(begin, end, Stage::Rest, current, [&](Index row, auto const&, double const* limit) {
            size_t const at = static_cast<size_t>(row) * Length;
            double square = 0.0;
            for (size_t i = 0; i < Length; ++i) {
                double const residual = problem.data[at + i] - limit[i];
                square += residual * residual;
                double const p = current[at + i];
                previous[at + i] = p + a * (p - previous[at + i]) + b * residual;
            }
            // Not std::max: a residual that is no number must be seen.
            largest = square <= largest ? largest : square;
        });
        return largest;
    });
    double largest = 0.0;
    for (double maximum : maxima) largest = maximum <= largest ? largest : maximum;
    return std::sqrt(largest);
}

/// Watches Chebyshev's convergence: the mean factor per step over the last steps since the bound was set.
class RateWatch {
public:
    static constexpr int kWindow = 6;

    void Restart() { _residuals.clear(); }
    void Add(double residual) { _residuals.push_back(residual); }
    bool IsReady() const { return _residuals.size() > kWindow + 2; }
    double GetRate() const {
        size_t const last = _residuals.size() - 1;
        return std::pow(_residuals[last] / _residuals[last - kWindow], 1.0 / kWindow);
    }

private:
    std::vector<double> _residuals;
};

}  // namespace

IterationResult RunStationary(LimitProblem const& problem, StationaryMethod method, double lambda, double smallest) {
    IterationResult result;
    size_t const count = static_cast<size_t>(problem.A.GetNumVertices()) * problem.length;
    std::vector<double> memory(problem.solution, problem.solution + count);
    double *current = problem.solution, *previous = memory.data();
    Schedule schedule(method, lambda);
    RateWatch watch;
    while (result.applications < problem.maxApplications) {
        double a, b;
        schedule.Advance(a, b);
        WithLength(problem.length, [&]<int Length>() { result.residual = Step<Length>(problem, current, previous, a, b) / problem.size; });
        ++result.applications;
        result.history.push_back(result.residual);
        if (problem.onIteration) problem.onIteration(result.applications, result.residual);
        result.converged = result.residual <= problem.tolerance;
        if (result.converged) break;
        std::swap(current, previous);
        if (!(result.residual < 1e30)) {
            result.isStuck = true;
            break;
        }
        watch.Add(result.residual);
        if (method != StationaryMethod::Chebyshev || !watch.IsReady()) continue;
        double const rate = watch.GetRate();
        if (rate < std::sqrt(schedule.GetExpectedRate())) continue;  // half as fast as hoped is still well
        // The slowest mode's eigenvalue, and some room: an underestimate costs little, an overestimate much.
        double const bound = 0.8 * schedule.FindEigenvalue(rate);
        if (!(bound > smallest)) {
            result.isStuck = true;
            break;
        }
        schedule.Restart(std::min(bound, 0.8 * schedule.GetLambda()));
        watch.Restart();
    }
    result.lambdaMin = method == StationaryMethod::Progressive ? 0.0 : schedule.GetLambda();
    if (current != problem.solution) std::copy_n(current, count, problem.solution);
    return result;
}

double FindResidual(LimitProblem const& problem, Index* worst) {
    struct Largest {
        double square = -1.0;
        Index row = -1;
    };
    Largest largest;
    WithLength(problem.length, [&]<int Length>() {
        auto const maxima = MapChunks(problem.A.GetNumVertices(), [&](Index begin, Index end) {
            Largest found;
            problem.A.ForEachRow<Length>(begin, end, Stage::Fixed, problem.solution, [&](Index row, auto const&, double const* limit) {
                double square = 0.0;
                for (size_t i = 0; i < Length; ++i) {
                    double const residual = problem.data[static_cast<size_t>(row) * Length + i] - limit[i];
                    square += residual * residual;
                }
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
