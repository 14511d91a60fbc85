// SPDX-License-Identifier: Apache-2.0
#include "eval/cascade/cascade_solve.h"

#include <algorithm>
#include <cmath>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "eval/parallel/rows.h"
#include "far_ext/error.h"

namespace limn::eval {

namespace {

using far_ext::CascadeLevel;
using Operator = CascadeOperator<double>;
using Row = CascadeRow<double>;

constexpr double kNothing = 1e-290;       // squares below it have lost their digits
constexpr double kLeastResidual = 1e-16;  // what steps change below it is rounding

/// a / b per coordinate; 0 where there is nothing left to divide by.
Row Divide(Row const& a, Row const& b) {
    return (b > kNothing).select(a / (b > kNothing).select(b, 1.0), 0.0);
}

/// Size of a residual to that of the data, from sums of squares per coordinate.
double FindRelativeSize(Row const& residual, Row const& data) {
    auto const ratio = [](double r, double d) {
        return r > 0.0 ? std::sqrt(r / std::max(d, 1e-300)) : 0.0;
    };
    return std::max(ratio(residual.head<3>().sum(), data.head<3>().sum()),
                    ratio(residual[3], data[3]));
}

/// Sum over unknowns of (M (X0 - centroid))^2; of the widths without centroid.
template <class Scalar>
Row MeasureData(CascadeLevel const& level, CascadeOperator<Scalar> const& op,
                CascadeRows<Scalar> const& x0) {
    Row centroid = Row::Zero();
    if (level.numUnknowns > 0) {
        centroid = SumRows(level.numUnknowns,
                           [&](Index row) -> Row { return x0[row].template cast<double>(); }) /
                   level.numUnknowns;
    }
    centroid[3] = 0.0;
    return SumRows(level.numUnknowns, [&](Index row) -> Row {
        return (static_cast<double>(op.masses[row]) * (x0[row].template cast<double>() - centroid))
            .square();
    });
}

/// The rows from begin to end and what is known of their equation. All others keep their values.
struct EquationRows {
    CascadeLevel const& level;
    Operator const& op;
    CascadeRows<double> const& x0;
    Index begin, end;

    size_t At(Index row) const { return row - begin; }
    bool Contains(Index row) const { return row >= begin && row < end; }
    bool IsMoved(Index row) const { return op.diagonals[row] > 0.0; }

    template <class Term>
    Row Sum(Term const& term) const {
        return SumRows(end - begin, [&](Index i) -> Row { return term(begin + i); });
    }
};

/// (M + L) X = M X0.
class SecondOrder : public EquationRows {
public:
    explicit SecondOrder(EquationRows const& rows) : EquationRows(rows) {}

    void PrepareResidual(CascadeRows<double> const&) {}
    Row GetResidual(CascadeRows<double> const& x, Index row) const {
        return FindResidual(level, op, x.data(), x0.data(), row);
    }

    void PrepareImage(CascadeRows<double> const&) {}
    /// Of a direction, which is 0 at all rows but begin to end.
    Row GetImage(CascadeRows<double> const& direction, Index row) const {
        Row sum = op.diagonals[row] * direction[At(row)];
        if (op.diagonals[row] == 0.0) return sum;
        for (int k = level.offsets[row]; k < level.offsets[row + 1]; ++k) {
            Index const other = level.neighbours[k];
            if (Contains(other)) sum -= op.edges[k] * direction[At(other)];
        }
        return sum;
    }
    double GetDiagonal(Index row) const { return op.diagonals[row]; }
};

/// (M + L M^-1 L) X = M X0, where M^-1 L X is 0 at all rows but those that it moves.
class FourthOrder : public EquationRows {
public:
    explicit FourthOrder(EquationRows const& rows)
        : EquationRows(rows), _bend(end - begin, Row::Zero()), _diagonals(end - begin, 0.0) {
        ForEachRow(end - begin, [&](Index i) { _diagonals[i] = FindDiagonal(begin + i); });
    }

    void PrepareResidual(CascadeRows<double> const& x) {
        FillBend([&](Index other) -> Row { return x[other]; });
    }
    Row GetResidual(CascadeRows<double> const& x, Index row) const {
        return op.masses[row] * (x0[row] - x[row]) - ApplyToBend(row);
    }

    void PrepareImage(CascadeRows<double> const& direction) {
        FillBend([&](Index other) -> Row {
            return Contains(other) ? direction[At(other)] : Row(Row::Zero());
        });
    }
    Row GetImage(CascadeRows<double> const& direction, Index row) const {
        return op.masses[row] * direction[At(row)] + ApplyToBend(row);
    }
    double GetDiagonal(Index row) const { return _diagonals[At(row)]; }

private:
    double FindDiagonal(Index row) const {
        if (!IsMoved(row)) return 0.0;
        double const own = op.diagonals[row] - op.masses[row];
        double sum = op.masses[row] + own * own / op.masses[row];
        for (int k = level.offsets[row]; k < level.offsets[row + 1]; ++k) {
            Index const other = level.neighbours[k];
            if (Contains(other) && IsMoved(other))
                sum += op.edges[k] * op.edges[k] / op.masses[other];
        }
        return sum;
    }

    /// L of a row applied to values, in differences, which cancel less.
    template <class GetValue>
    Row Apply(Index row, GetValue const& get) const {
        Row const own = get(row);
        Row sum = Row::Zero();
        for (int k = level.offsets[row]; k < level.offsets[row + 1]; ++k)
            sum += op.edges[k] * (own - get(level.neighbours[k]));
        return sum;
    }

    template <class GetValue>
    void FillBend(GetValue const& get) {
        ForEachRow(end - begin, [&](Index i) {
            Index const row = begin + i;
            _bend[i] = IsMoved(row) ? Row(Apply(row, get) / op.masses[row]) : Row(Row::Zero());
        });
    }
    Row ApplyToBend(Index row) const {
        return Apply(row, [&](Index other) -> Row {
            return Contains(other) ? _bend[At(other)] : Row(Row::Zero());
        });
    }

    CascadeRows<double> _bend;  // M^-1 L of what was prepared
    far_ext::LargeArray<double> _diagonals;
};

/// Conjugate gradients for the rows of an equation.
template <class Equation>
class ConjugateGradientRows {
public:
    ConjugateGradientRows(EquationRows const& rows, CascadeRows<double>& x)
        : _equation(rows), _x(x) {
        size_t const count = rows.end - rows.begin;
        for (auto* values : {&_residual, &_direction, &_image}) values->assign(count, Row::Zero());
    }

    CascadeSolve Run(Row const& data, int maxIterations, double tolerance,
                     std::function<void(double)> const& progress) {
        CascadeSolve result;
        double first = 0.0;
        _isPreconditioned = tolerance > 0.0;
        Row energy = Row::Zero();
        Row squares = FindResiduals();
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
            Row const before = energy;
            energy = Sum([&](Index row) { return _residual[At(row)].square() * GetInverse(row); });
            Row const momentum = Divide(energy, before);
            ForEachRow(static_cast<Index>(_direction.size()), [&](Index i) {
                _direction[i] =
                    _residual[i] * GetInverse(_equation.begin + i) + momentum * _direction[i];
            });
            squares = TakeStep(energy);
            ++result.iterations;
        }
    }

private:
    size_t At(Index row) const { return _equation.At(row); }
    double GetInverse(Index row) const {
        if (!_equation.IsMoved(row)) return 0.0;
        return _isPreconditioned ? 1.0 / _equation.GetDiagonal(row) : 1.0;
    }

    template <class Term>
    Row Sum(Term const& term) const {
        return _equation.Sum(term);
    }

    /// \return  the sum of their squares
    Row FindResiduals() {
        _equation.PrepareResidual(_x);
        return Sum([&](Index row) {
            _residual[At(row)] =
                _equation.GetResidual(_x, row) * (_equation.IsMoved(row) ? 1.0 : 0.0);
            return _residual[At(row)].square();
        });
    }

    /// \return  as FindResiduals
    Row TakeStep(Row const& energy) {
        _equation.PrepareImage(_direction);
        Row const curvature = Sum([&](Index row) {
            _image[At(row)] = _equation.GetImage(_direction, row);
            return _image[At(row)] * _direction[At(row)];
        });
        Row const step = Divide(energy, curvature);
        return Sum([&](Index row) {
            _x[row] += step * _direction[At(row)];
            _residual[At(row)] -= step * _image[At(row)];
            return _residual[At(row)].square();
        });
    }

    Equation _equation;
    CascadeRows<double>& _x;
    bool _isPreconditioned = true;
    CascadeRows<double> _residual, _direction,
        _image;  // directions of rows that nothing moves stay 0
};

/// Squares of what an equation of order 4 leaves.
Row SumResiduals(EquationRows const& rows, CascadeRows<double> const& x) {
    FourthOrder equation(rows);
    equation.PrepareResidual(x);
    return rows.Sum([&](Index row) {
        return rows.IsMoved(row) ? Row(equation.GetResidual(x, row).square()) : Row(Row::Zero());
    });
}

using SparseMatrix = Eigen::SparseMatrix<double>;

/// An equation as a matrix; 1 on the diagonal where nothing moves a row.
struct SparseEquation {
    SparseMatrix matrix;
    Eigen::MatrixXd rightSide;

    SparseEquation(EquationRows const& rows, CascadeRows<double> const& x)
        : matrix(rows.end - rows.begin, rows.end - rows.begin), rightSide(matrix.rows(), 4) {
        bool const isSecond = rows.op.order == 2;
        std::vector<Eigen::Triplet<double>> entries;
        Eigen::VectorXd masses = Eigen::VectorXd::Ones(matrix.rows());
        for (Index row = rows.begin; row < rows.end; ++row) {
            bool const isMoved = rows.IsMoved(row);
            Index const i = row - rows.begin;
            entries.emplace_back(i, i, isMoved ? rows.op.diagonals[row] : 1.0);
            Row const data = isMoved ? Row(rows.op.masses[row] * rows.x0[row]) : x[row];
            rightSide.row(i) = (isSecond ? data : Row(Row::Zero())).matrix().transpose();
            if (!isMoved) continue;
            masses[i] = rows.op.masses[row];
            for (int k = rows.level.offsets[row]; k < rows.level.offsets[row + 1]; ++k) {
                Index const other = rows.level.neighbours[k];
                if (rows.Contains(other) && rows.IsMoved(other))
                    entries.emplace_back(i, other - rows.begin, -rows.op.edges[k]);
                else
                    rightSide.row(i) += (rows.op.edges[k] * x[other]).matrix().transpose();
            }
        }
        matrix.setFromTriplets(entries.begin(), entries.end());
        if (!isSecond) Square(rows, x, masses);
    }

private:
    /// From M + L, and minus L of what is given, to the equation of order 4.
    void Square(EquationRows const& rows, CascadeRows<double> const& x,
                Eigen::VectorXd const& masses) {
        SparseMatrix const M(masses.asDiagonal()), L = matrix - M;
        SparseMatrix const bend = L * masses.cwiseInverse().asDiagonal();
        matrix = M + SparseMatrix(bend * L);
        rightSide = (bend * rightSide).eval();
        for (Index row = rows.begin; row < rows.end; ++row) {
            Row const data = rows.IsMoved(row) ? rows.x0[row] : x[row];
            Index const i = row - rows.begin;
            rightSide.row(i) += masses[i] * data.matrix().transpose();
        }
    }
};

void SolveRowsByCholesky(EquationRows const& rows, CascadeRows<double>& x) {
    if (rows.begin == rows.end) return;
    SparseEquation const equation(rows, x);
    Eigen::SimplicialLDLT<SparseMatrix> const cholesky(equation.matrix);
    if (cholesky.info() != Eigen::Success) {
        throw Error(
            ErrorCode::BadMesh,
            "the filter's equation cannot be factorised; `solver` cg needs no factorisation");
    }
    Eigen::MatrixXd const solution = cholesky.solve(equation.rightSide);
    for (Index row = rows.begin; row < rows.end; ++row) {
        if (rows.IsMoved(row)) x[row] = solution.row(row - rows.begin).transpose().array();
    }
}

}  // namespace

template <class Scalar>
double MeasureResidual(CascadeLevel const& level, CascadeOperator<Scalar> const& op,
                       CascadeRows<Scalar> const& x, CascadeRows<Scalar> const& x0) {
    Row const squares = SumRows(level.numUnknowns, [&](Index row) -> Row {
        if (op.diagonals[row] == Scalar(0)) return Row::Zero();
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
    Row const data = MeasureData(level, op, x0);
    double const share = level.numSurface < level.numUnknowns
                             ? std::sqrt(0.5)
                             : 1.0;  // so that both together keep it
    auto const run = [&](Index begin, Index end) {
        EquationRows const rows{level, op, x0, begin, end};
        auto const solve = [&]<class Equation>(ConjugateGradientRows<Equation> gradients) {
            return gradients.Run(data, maxIterations, share * tolerance, progress);
        };
        return op.order == 4 ? solve(ConjugateGradientRows<FourthOrder>(rows, x))
                             : solve(ConjugateGradientRows<SecondOrder>(rows, x));
    };
    CascadeSolve const creases = run(level.numSurface, level.numUnknowns),
                       surface = run(0, level.numSurface);
    return {std::max(creases.iterations, surface.iterations),
            std::hypot(creases.residual, surface.residual), creases.converged && surface.converged};
}

CascadeSolve SolveByCholesky(CascadeLevel const& level, Operator const& op,
                             CascadeRows<double> const& x0, CascadeRows<double>& x) {
    EquationRows const creases{level, op, x0, level.numSurface, level.numUnknowns},
        surface{level, op, x0, 0, level.numSurface};
    SolveRowsByCholesky(creases, x);
    SolveRowsByCholesky(surface, x);
    if (op.order == 2) return {1, MeasureResidual(level, op, x, x0), true};
    Row const squares = SumResiduals(creases, x) + SumResiduals(surface, x);
    return {1, FindRelativeSize(squares, MeasureData(level, op, x0)), true};
}

}  // namespace limn::eval
