// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "eval/fit/limit_problem.h"

namespace limn::eval {

/// Coefficients a and b of the steps of a stationary iteration; Chebyshev's for eigenvalues in
/// [lambda, 1].
class StepSchedule {
public:
    StepSchedule(StationaryMethod method, double lambda) : _method(method) { Restart(lambda); }

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

    /// The eigenvalue whose mode shrinks by `rate` per step; the bound was too high if that is
    /// slow.
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

/// Watches Chebyshev's convergence: the mean factor per step over the last steps since the bound
/// was set.
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

/// Lowers a schedule's bound where modes below it hold convergence up.
///
/// \return  false where that would go below `smallest`
inline bool LowerBound(StepSchedule& schedule, RateWatch& watch, double smallest) {
    double const rate = watch.GetRate();
    if (rate < std::sqrt(schedule.GetExpectedRate())) return true;  // half as fast as hoped is well
    // The slowest mode's eigenvalue, and some room: an underestimate costs little, an overestimate
    // much.
    double const bound = std::min(0.8 * schedule.FindEigenvalue(rate), 0.8 * schedule.GetLambda());
    if (!(bound > smallest)) return false;
    schedule.Restart(bound);
    watch.Restart();
    return true;
}

}  // namespace limn::eval
