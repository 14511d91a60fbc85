#include <algorithm>
#include <cmath>
#include <utility>

#include "eval/limit_problem.h"

namespace limn::eval {

namespace {

using Stage = LimitOperator::Stage;

/// The larger one; not std::max, since a residual that is no number must be seen.
template <class Real>
Real Larger(Real value, Real largest) {
    return value <= largest ? largest : value;
}

template <class Real>
Real FindLargest(std::vector<Real> const& values) {
    Real largest = 0;
    for (Real value : values) largest = Larger(value, largest);
    return largest;
}

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

/// The inner iteration, in float: a correction E with A E = R, started at 0, in the unit of the data's size.
template <int Lanes>
class Correction {
public:
    explicit Correction(LimitOperator const& A) : _A(A), _right(static_cast<size_t>(A.GetNumVertices()) * Row::kStride, 0.0f), _current(_right), _previous(_right) {}

    /// One step in place, with max |R - A E| from before it.
    float Step(double a, double b) {
        float const fa = static_cast<float>(a), fb = static_cast<float>(b);
        auto const maxima = MapChunks(_A.GetNumVertices(), [&](Index begin, Index end) {
            float largest = 0.0f;
            _A.ForEachRow<Row>(begin, end, Stage::Rest, _current.data(), [&](Index row, auto const&, Row const& own, Row const& limit) {
                Row const residual = Row::Load(_right.data(), row) - limit;
                largest = std::max(largest, residual.SquaredLength());
                (own + fa * (own - Row::Load(_previous.data(), row)) + fb * residual).Store(_previous.data(), row);
            });
            return largest;
        });
        std::swap(_current, _previous);
        return std::sqrt(FindLargest(maxima));
    }

    /// Starts again at E = 0 for another right side, with the memory kept: what was E_k becomes 0, and E_{k-1} is
    /// less by it. The step that follows needs no A.
    void Restart(double a, double b) {
        float const fa = static_cast<float>(a), fb = static_cast<float>(b);
        ForEachChunk(_A.GetNumVertices(), [&](Index begin, Index end) {
            for (Index row = begin; row < end; ++row) {
                Row const before = Row::Load(_previous.data(), row) - Row::Load(_current.data(), row);
                (fb * Row::Load(_right.data(), row) - fa * before).Store(_previous.data(), row);
                Row().Store(_current.data(), row);
            }
        });
        std::swap(_current, _previous);
    }

    float* GetRight() { return _right.data(); }
    float const* Get() const { return _current.data(); }
    static constexpr size_t kStride = FloatRow<Lanes>::kStride;

private:
    using Row = FloatRow<Lanes>;

    LimitOperator const& _A;
    std::vector<float> _right, _current, _previous;  // of vertices that are not of the rest: 0
};

/// Watches Chebyshev's convergence: the mean factor per step over the last steps since the bound was set.
class RateWatch {
public:
    static constexpr int kWindow = 6;

    void Restart() { _residuals.clear(); }
    void Add(double residual) { _residuals.push_back(residual); }
    bool IsReady() const { return _residuals.size() > kWindow + 3; }
    double GetRate() const {
        // A single mode swings through zero: the larger of two neighbours tells its size.
        auto const at = [&](size_t k) { return std::max(_residuals[k], _residuals[k - 1]); };
        size_t const last = _residuals.size() - 1;
        return std::pow(at(last) / at(last - kWindow), 1.0 / kWindow);
    }

private:
    std::vector<double> _residuals;
};

/// The outer iteration, in double: R = M - A P, P += E until R is small enough.
template <int Length>
class StationarySolve {
public:
    StationarySolve(LimitProblem const& problem, StationaryMethod method, double lambda, double smallest)
        : _problem(problem), _method(method), _schedule(method, lambda), _smallest(smallest), _correction(problem.A) {}

    IterationResult Run() {
        double before = 1e30;
        while (true) {
            double const residual = FindRight();
            if (!IsUsedUp()) Record(residual);
            _result.residual = residual;
            _result.converged = residual <= _problem.tolerance;
            // Not even half: rounding, divergence, or an eigenvalue that the inner steps cannot see.
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
    /// So far inner steps go, as a share of the right side; rounding in float ends them at about a tenth of it.
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
        auto const maxima = MapChunks(_problem.A.GetNumVertices(), [&](Index begin, Index end) {
            double largest = 0.0;
            _problem.A.ForEachRow<Row>(begin, end, Stage::Rest, _problem.solution, [&](Index row, auto const&, Row const&, Row const& limit) {
                Row const residual = Row::Load(_problem.data, row) - limit;
                largest = Larger(residual.SquaredLength(), largest);
                float* const right = _correction.GetRight() + static_cast<size_t>(row) * _correction.kStride;
                for (size_t i = 0; i < Length; ++i) right[i] = static_cast<float>(residual.values[i] / _problem.size);
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
        while (!IsUsedUp()) {
            _schedule.Advance(a, b);
            double const residual = static_cast<double>(_correction.Step(a, b));
            Record(residual);
            if (residual <= goal || !(residual < 1e4 * start)) return;
            _watch.Add(residual);
            if (_method == StationaryMethod::Chebyshev && _watch.IsReady() && !LowerBound()) return;
        }
    }

    /// Lowers the bound where modes below it hold convergence up. Returns false where that goes too far.
    bool LowerBound() {
        double const rate = _watch.GetRate();
        if (rate < std::sqrt(_schedule.GetExpectedRate())) return true;  // half as fast as hoped is still well
        // The slowest mode's eigenvalue, and some room: an underestimate costs little, an overestimate much.
        double const bound = std::min(0.8 * _schedule.FindEigenvalue(rate), 0.8 * _schedule.GetLambda());
        _result.isStuck = !(bound > _smallest);
        if (_result.isStuck) return false;
        _schedule.Restart(bound);
        _watch.Restart();
        return true;
    }

    void AddCorrection() {
        ForEachChunk(_problem.A.GetNumVertices(), [&](Index begin, Index end) {
            for (Index row = begin; row < end; ++row) {
                float const* const e = _correction.Get() + static_cast<size_t>(row) * _correction.kStride;
                double* const p = _problem.solution + static_cast<size_t>(row) * Length;
                for (size_t i = 0; i < Length; ++i) p[i] += _problem.size * static_cast<double>(e[i]);
            }
        });
    }

    LimitProblem const& _problem;
    StationaryMethod _method;
    Schedule _schedule;
    double _smallest;
    Correction<kLanes> _correction;
    RateWatch _watch;
    IterationResult _result;
};

}  // namespace

IterationResult RunStationary(LimitProblem const& problem, StationaryMethod method, double lambda, double smallest) {
    IterationResult result;
    WithLength(problem.length, [&]<int Length>() { result = StationarySolve<Length>(problem, method, lambda, smallest).Run(); });
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
            using Row = DoubleRow<Length>;
            problem.A.ForEachRow<Row>(begin, end, Stage::Fixed, problem.solution, [&](Index row, auto const&, Row const&, Row const& limit) {
                double const square = (Row::Load(problem.data, row) - limit).SquaredLength();
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
