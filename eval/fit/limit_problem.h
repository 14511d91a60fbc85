// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "eval/fit/limit_operator.h"
#include "eval/stencils/table_evaluator.h"

namespace limn::eval {

/// Called after each application of A with the number of them and the residual over the data's
/// size. May throw to end the solve.
using OnIteration = std::function<void(int applications, double residual)>;

/// A P = M for the rest of a LimitOperator's rows; fixed vertices and curves are solved and stay.
struct LimitProblem {
    LimitOperator const& A;
    int length;               ///< channels, 1 to 4
    double const* data;       ///< M, rows of `length`
    double* solution;         ///< P: the start, then the result
    double size = 1.0;        ///< of the data: residuals are told in this unit
    double tolerance = 1e-6;  ///< of max |M - A P|, in the unit `size`; a row's length counts
    int maxApplications = 1000;
    OnIteration onIteration{};
    FixedTable const* table = nullptr;  ///< A in float: iterations apply it to their steps, while
                                        ///< residuals stay in double

    /// The row of a vertex, in the data and in the solution.
    double const* GetData(Index vertex) const { return data + GetOffset(vertex); }
    double* GetSolution(Index vertex) const { return solution + GetOffset(vertex); }

private:
    size_t GetOffset(Index vertex) const { return static_cast<size_t>(vertex) * length; }
};

/// Rows whose sums and maxima are found in one block (see eval/parallel/rows.h).
inline constexpr Index kRowsPerSum = 4096;

/// How an iteration went.
struct IterationResult {
    int applications = 0;
    double residual = 0.0;        ///< of the last P, in the unit `size`
    std::vector<double> history;  ///< residual per application
    bool converged = false;
    bool isStuck = false;    ///< the method gave up: diverging, or too slow for it
    double lambdaMin = 0.0;  ///< what it found or used for A's smallest eigenvalue; 0: nothing
};

/// max |M - A P| over the rest of the rows, in the unit `size`; `worst` receives where it is.
double FindResidual(LimitProblem const& problem, Index* worst = nullptr);

/// A fixed-point iteration with one memory: P_{k+1} = P_k + a (P_k - P_{k-1}) + b (M - A P_k). A
/// step is one pass over the rows that applies A, measures the residual and updates in place, in
/// float: it finds a correction, which is added in double to P, whose residual is then found in
/// double, until that is small enough. Half the memory and traffic of doubles, and all their
/// digits.
enum class StationaryMethod {
    Progressive,  ///< a = 0, b = 1: [LaiCheng11] (7)
    Weighted,     ///< a = 0, b = 2 / (1 + lambda)
    Chebyshev     ///< a and b of the Chebyshev polynomials on [lambda, 1]
};

/// With a table RunByTable does it.
///
/// \param lambda  lower bound of the eigenvalues, in (0, 1). Chebyshev lowers it by itself where
///                convergence shows that it was too high, and is stuck where that would pass
///                `smallest`
IterationResult RunStationary(LimitProblem const& problem, StationaryMethod method, double lambda,
                              double smallest = 1e-6);

/// The same fixed-point iteration on residuals, with the problem's table. All but what it applies
/// is in double.
IterationResult RunByTable(LimitProblem const& problem, StationaryMethod method, double lambda,
                           double smallest = 1e-6);

/// Conjugate gradients in the inner product of D, each channel with its own step lengths.
///
/// \pre  the operator is symmetric; otherwise it may be stuck
IterationResult RunConjugateGradients(LimitProblem const& problem);

/// Sparse factorisation: LDL^T of D A, or LU where it is not symmetric or may be indefinite
/// (valence 2).
///
/// \param pinned  rows whose unknown is 0 and whose equation is dropped
IterationResult SolveDirectly(LimitProblem const& problem, std::vector<Index> const& pinned);

/// Solves fixed vertices and curves (a tridiagonal system per curve) exactly; the rest of P is not
/// touched.
void SolveCurves(LimitProblem const& problem);

}  // namespace limn::eval
