// SPDX-License-Identifier: Apache-2.0
#include "eval/cascade/cascade_solve.h"

#include <algorithm>
#include <cmath>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "far_ext/error.h"

namespace limn::eval {

namespace {

using far_ext::CascadeLevel;
using Operator = CascadeOperator<double>;

constexpr double kNothing = 1e-290;       // squares below it have lost their digits
constexpr double kLeastResidual = 1e-16;  // what steps change below it is rounding

/// a / b per coordinate; 0 where there is nothing left to divide by.
DoubleLanes Divide(DoubleLanes const& a, DoubleLanes const& b) {
    return (b > kNothing).select(a / (b > kNothing).select(b, 1.0), 0.0);
}

/// Size of a residual to that of the data, from sums of squares per coordinate.
double FindRelativeSize(DoubleLanes const& residual, DoubleLanes const& data) {
    auto const ratio = [](double r, double d) {
        return r > 0.0 ? std::sqrt(r / std::max(d, 1e-300)) : 0.0;
    };
    return std::max(ratio(residual.head<3>().sum(), data.head<3>().sum()),
                    ratio(residual[3], data[3]));
}

/// Sum over unknowns of (M (X0 - centroid))^2; of the widths without centroid.
template <class Scalar>
DoubleLanes MeasureData(CascadeLevel const& level, CascadeOperator<Scalar> const& op,
                        CascadeRows<Scalar> const& x0) {
    DoubleLanes centroid = DoubleLanes::Zero();
    if (level.numUnknowns > 0) {
        centroid =
            SumRows(level.numUnknowns,
                    [&](Index row) -> DoubleLanes { return x0[row].template cast<double>(); }) /
            level.numUnknowns;
    }
    centroid[3] = 0.0;
    return SumRows(level.numUnknowns, [&](Index row) -> DoubleLanes {
        return (static_cast<double>(op.masses[row]) * (x0[row].template cast<double>() - centroid))
            .square();
    });
}

/// Conjugate gradients for the rows from begin to end; all others keep their values.
class ConjugateGradientRows {
public:
    ConjugateGradientRows(CascadeLevel const& level, Operator const& op,
                          CascadeRows<double> const& x0, CascadeRows<double>& x, Index begin,
                          Index end)
        : _level(level), _op(op), _x0(x0), _x(x), _begin(begin), _end(end) {
        size_t const count = static_cast<size_t>(end - begin);
        for (auto* rows : {&_residual, &_direction, &_image})
            rows->assign(count, DoubleLanes::Zero());
    }

    CascadeSolve Run(DoubleLanes const& data, int maxIterations, double tolerance,
                     std::function<void(double)> const& progress) {
        CascadeSolve result;
        double first = 0.0;
        _isPreconditioned = tolerance > 0.0;
        DoubleLanes energy = DoubleLanes::Zero();
        DoubleLanes squares = Sum([&](Index row) {
            _residual[At(row)] =
                FindResidual(_level, _op, _x.data(), _x0.data(), row) * IsMoved(row);
            return _residual[At(row)].square();
        });
        while (true) {
            result.residual = FindRelativeSize(squares, data);
            result.converged = result.residual <= tolerance;
            if (result.converged || result.iterations >= maxIterations ||
                result.residual < kLeastResidual)
                return result;
            if (result.iterations == 0) first = result.residual;
            if (progress) {
                double const byCount = static_cast<double>(result.iterations) / maxIterations;
                double const byResidual = tolerance > 0.0 ? std::log(first / result.residual) /
                                                                std::log(first / tolerance)
                                                          : 0.0;
                progress(std::clamp(std::max(byCount, byResidual), 0.0, 1.0));
            }
            DoubleLanes const before = energy;
            energy = Sum([&](Index row) { return _residual[At(row)].square() * GetInverse(row); });
            DoubleLanes const momentum = Divide(energy, before);
            ForEachRow(_end - _begin, [&](Index i) {
                _direction[i] = _residual[i] * GetInverse(_begin + i) + momentum * _direction[i];
            });
            DoubleLanes const curvature = Sum([&](Index row) {
                _image[At(row)] = Apply(row);
                return _image[At(row)] * _direction[At(row)];
            });
            DoubleLanes const step = Divide(energy, curvature);
            squares = Sum([&](Index row) {
                _x[row] += step * _direction[At(row)];
                _residual[At(row)] -= step * _image[At(row)];
                return _residual[At(row)].square();
            });
            ++result.iterations;
        }
    }

private:
    size_t At(Index row) const { return static_cast<size_t>(row - _begin); }
    double IsMoved(Index row) const { return _op.diagonals[row] > 0.0 ? 1.0 : 0.0; }
    double GetInverse(Index row) const {
        return !_isPreconditioned         ? IsMoved(row)
               : _op.diagonals[row] > 0.0 ? 1.0 / _op.diagonals[row]
                                          : 0.0;
    }

    template <class Term>
    DoubleLanes Sum(Term const& term) const {
        return SumRows(_end - _begin, [&](Index i) -> DoubleLanes { return term(_begin + i); });
    }

    DoubleLanes Apply(Index row) const {
        DoubleLanes sum = _op.diagonals[row] * _direction[At(row)];
        if (_op.diagonals[row] == 0.0) return sum;
        for (int k = _level.offsets[row]; k < _level.offsets[row + 1]; ++k) {
            Index const other = _level.neighbours[k];
            if (other >= _begin && other < _end) sum -= _op.edges[k] * _direction[At(other)];
        }
        return sum;
    }

    CascadeLevel const& _level;
    Operator const& _op;
    CascadeRows<double> const& _x0;
    CascadeRows<double>& _x;
    Index _begin, _end;
    bool _isPreconditioned = true;
    CascadeRows<double> _residual, _direction,
        _image;  // directions of rows that nothing moves stay 0
};

void SolveRowsByCholesky(CascadeLevel const& level, Operator const& op,
                         CascadeRows<double> const& x0, CascadeRows<double>& x, Index begin,
                         Index end) {
    if (begin == end) return;
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixXd rightSide = Eigen::MatrixXd::Zero(end - begin, 4);
    for (Index row = begin; row < end; ++row) {
        bool const isMoved = op.diagonals[row] > 0.0;
        Index const i = row - begin;
        entries.emplace_back(i, i, isMoved ? op.diagonals[row] : 1.0);
        rightSide.row(i) =
            (isMoved ? DoubleLanes(op.masses[row] * x0[row]) : x[row]).matrix().transpose();
        if (!isMoved) continue;
        for (int k = level.offsets[row]; k < level.offsets[row + 1]; ++k) {
            Index const other = level.neighbours[k];
            bool const isUnknown = other >= begin && other < end && op.diagonals[other] > 0.0;
            if (isUnknown)
                entries.emplace_back(i, other - begin, -op.edges[k]);
            else
                rightSide.row(i) += (op.edges[k] * x[other]).matrix().transpose();
        }
    }
    Eigen::SparseMatrix<double> matrix(end - begin, end - begin);
    matrix.setFromTriplets(entries.begin(), entries.end());
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> const cholesky(matrix);
    if (cholesky.info() != Eigen::Success) {
        throw Error(
            ErrorCode::BadMesh,
            "the filter's equation cannot be factorised; `solver` cg needs no factorisation");
    }
    Eigen::MatrixXd const solution = cholesky.solve(rightSide);
    for (Index row = begin; row < end; ++row) {
        if (op.diagonals[row] > 0.0) x[row] = solution.row(row - begin).transpose().array();
    }
}

}  // namespace

template <class Scalar>
double MeasureResidual(CascadeLevel const& level, CascadeOperator<Scalar> const& op,
                       CascadeRows<Scalar> const& x, CascadeRows<Scalar> const& x0) {
    DoubleLanes const squares = SumRows(level.numUnknowns, [&](Index row) -> DoubleLanes {
        if (op.diagonals[row] == Scalar(0)) return DoubleLanes::Zero();
        return FindResidual(level, op, x.data(), x0.data(), row).template cast<double>().square();
    });
    return FindRelativeSize(squares, MeasureData(level, op, x0));
}

template double MeasureResidual(CascadeLevel const&, CascadeOperator<float> const&,
                                CascadeRows<float> const&, CascadeRows<float> const&);
template double MeasureResidual(CascadeLevel const&, CascadeOperator<double> const&,
                                CascadeRows<double> const&, CascadeRows<double> const&);

CascadeSolve SolveByConjugateGradients(CascadeLevel const& level, Operator const& op,
                                       CascadeRows<double> const& x0, CascadeRows<double>& x,
                                       int maxIterations, double tolerance,
                                       std::function<void(double)> const& progress) {
    DoubleLanes const data = MeasureData(level, op, x0);
    double const share = level.numSurface < level.numUnknowns
                             ? std::sqrt(0.5)
                             : 1.0;  // so that both together keep it
    auto const run = [&](Index begin, Index end) {
        return ConjugateGradientRows(level, op, x0, x, begin, end)
            .Run(data, maxIterations, share * tolerance, progress);
    };
    CascadeSolve const creases = run(level.numSurface, level.numUnknowns),
                       surface = run(0, level.numSurface);
    return {std::max(creases.iterations, surface.iterations),
            std::hypot(creases.residual, surface.residual), creases.converged && surface.converged};
}

CascadeSolve SolveByCholesky(CascadeLevel const& level, Operator const& op,
                             CascadeRows<double> const& x0, CascadeRows<double>& x) {
    SolveRowsByCholesky(level, op, x0, x, level.numSurface, level.numUnknowns);
    SolveRowsByCholesky(level, op, x0, x, 0, level.numSurface);
    return {1, MeasureResidual(level, op, x, x0), true};
}

}  // namespace limn::eval
