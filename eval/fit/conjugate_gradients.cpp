// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "eval/fit/limit_problem.h"
#include "eval/parallel/rows.h"

namespace limn::eval {

namespace {

using Stage = LimitOperator::Stage;

template <int Length>
using Sums = std::array<double, Length>;

/// One solve; rows of `Length` doubles, a step length per channel.
template <int Length>
class ConjugateGradients {
public:
    explicit ConjugateGradients(LimitProblem const& problem)
        : _problem(problem),
          _count(problem.A.GetNumVertices()),
          _r(At(_count), 0.0),
          _p(_r),
          _q(_r) {}

    IterationResult Run() {
        IterationResult result;
        auto const record = [&](double residual) {
            ++result.applications;
            result.residual = residual / _problem.size;
            result.history.push_back(result.residual);
            if (_problem.onIteration) _problem.onIteration(result.applications, result.residual);
            result.converged = result.residual <= _problem.tolerance;
        };
        record(Start());
        while (!result.converged && !result.isStuck &&
               result.applications < _problem.maxApplications) {
            Sums<Length> const energy = Apply();
            Sums<Length> alpha{}, beta{};
            for (size_t i = 0; i < Length; ++i) {
                if (_square[i] > 0.0 && !(energy[i] > 0.0))
                    result.isStuck = true;  // not positive definite
                else if (_square[i] > 0.0)
                    alpha[i] = _square[i] / energy[i];
            }
            if (result.isStuck) break;
            Sums<Length> const before = _square;
            record(Advance(alpha));
            for (size_t i = 0; i < Length; ++i)
                beta[i] = before[i] > 0.0 ? _square[i] / before[i] : 0.0;
            Turn(beta);
            _alphas.push_back(alpha[0]);
            _betas.push_back(beta[0]);
            if (!(result.residual < 1e30)) result.isStuck = true;
        }
        result.lambdaMin = FindSmallestRitzValue();
        return result;
    }

private:
    using Row = DoubleRow<Length>;

    static size_t At(Index row) { return static_cast<size_t>(row) * Length; }

    /// r = M - A P, p = r, and <r, r>. Returns max |r|.
    double Start() {
        return Sum([&](Index begin, Index end, Partial& partial) {
            _problem.A.ForEachRow<Row>(begin, end, Stage::Rest, _problem.solution,
                                       [&](Index row, auto const& c, Row const&, Row const& limit) {
                                           Row const residual =
                                               Row::Load(_problem.data, row) - limit;
                                           residual.Store(_r.data(), row);
                                           residual.Store(_p.data(), row);
                                           partial.Add(residual, c.scale);
                                       });
        });
    }

    /// q = A p, for rows begin to end, and their part of <p, q>.
    Sums<Length> ApplyRows(Index begin, Index end) {
        Sums<Length> sum{};
        auto const add = [&](auto const& c, Row const& own, Row const& product) {
            for (size_t i = 0; i < Length; ++i)
                sum[i] += c.scale * own.values[i] * product.values[i];
        };
        if (!_problem.table) {
            _problem.A.ForEachRow<Row>(
                begin, end, Stage::Rest, _p.data(),
                [&](Index row, auto const& c, Row const& own, Row const& product) {
                    product.Store(_q.data(), row);
                    add(c, own, product);
                });
            return sum;
        }
        for (Index row = begin; row < end; ++row) {
            auto const& c = _problem.A.GetClass(row);
            if (c.stage == Stage::Rest)
                add(c, Row::Load(_p.data(), row), Row::Load(_q.data(), row));
        }
        return sum;
    }

    /// q = A p and <p, q>.
    Sums<Length> Apply() {
        if (_problem.table) _problem.table->Apply(_p, Length, _q);
        auto const partials = MapBlocks(
            _count, kRowsPerSum, [&](Index begin, Index end) { return ApplyRows(begin, end); });
        Sums<Length> total{};
        for (auto const& partial : partials) {
            for (size_t i = 0; i < Length; ++i) total[i] += partial[i];
        }
        return total;
    }

    /// P += alpha p, r -= alpha q, and <r, r>. Returns max |r|.
    double Advance(Sums<Length> const& alpha) {
        return Sum([&](Index begin, Index end, Partial& partial) {
            for (Index row = begin; row < end; ++row) {
                auto const& c = _problem.A.GetClass(row);
                if (c.stage != Stage::Rest) continue;
                for (size_t i = 0; i < Length; ++i) {
                    _problem.solution[At(row) + i] += alpha[i] * _p[At(row) + i];
                    _r[At(row) + i] -= alpha[i] * _q[At(row) + i];
                }
                partial.Add(Row::Load(_r.data(), row), c.scale);
            }
        });
    }

    /// p = r + beta p.
    void Turn(Sums<Length> const& beta) {
        ForEachRow(_count, [&](Index row) {
            for (size_t i = 0; i < Length; ++i)
                _p[At(row) + i] = _r[At(row) + i] + beta[i] * _p[At(row) + i];
        });
    }

    struct Partial {
        Sums<Length> square{};
        double largest = 0.0;

        void Add(Row const& r, double scale) {
            for (size_t i = 0; i < Length; ++i) square[i] += scale * r.values[i] * r.values[i];
            double const length = r.SquaredLength();
            largest = length <= largest ? largest : length;
        }
    };

    template <class Work>
    double Sum(Work const& work) {
        auto const partials = MapBlocks(_count, kRowsPerSum, [&](Index begin, Index end) {
            Partial partial;
            work(begin, end, partial);
            return partial;
        });
        _square.fill(0.0);
        double largest = 0.0;
        for (Partial const& partial : partials) {
            for (size_t i = 0; i < Length; ++i) _square[i] += partial.square[i];
            largest = partial.largest <= largest ? largest : partial.largest;
        }
        return std::sqrt(largest);
    }

    /// Of the first channel: the step lengths are the Lanczos matrix of A.
    double FindSmallestRitzValue() const {
        Eigen::Index size = 0;
        while (size < static_cast<Eigen::Index>(_alphas.size()) && _alphas[size] > 0.0) ++size;
        if (size == 0) return 0.0;
        Eigen::VectorXd diagonal(size), beside(std::max<Eigen::Index>(size - 1, 0));
        for (Eigen::Index k = 0; k < size; ++k) {
            diagonal[k] = 1.0 / _alphas[k] + (k > 0 ? _betas[k - 1] / _alphas[k - 1] : 0.0);
            if (k + 1 < size) beside[k] = std::sqrt(_betas[k]) / _alphas[k];
        }
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
        solver.computeFromTridiagonal(diagonal, beside, Eigen::EigenvaluesOnly);
        return solver.eigenvalues()[0];
    }

    LimitProblem const& _problem;
    Index _count;
    std::vector<double> _r, _p, _q;
    Sums<Length> _square{};
    std::vector<double> _alphas, _betas;
};

}  // namespace

IterationResult RunConjugateGradients(LimitProblem const& problem) {
    IterationResult result;
    WithLength(problem.length,
               [&]<int Length>() { result = ConjugateGradients<Length>(problem).Run(); });
    return result;
}

}  // namespace limn::eval
