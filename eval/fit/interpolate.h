// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "eval/fit/limit_problem.h"
#include "eval/fit/singular_components.h"
#include "far_ext/enum_words.h"

namespace limn::eval {

/// Which way A P = M is solved. Automatic takes the fastest that converges: Chebyshev; where A's
/// smallest eigenvalues make that slow, conjugate gradients; where A is not positive, a
/// factorisation.
enum class SolveMethod { Automatic, Progressive, Weighted, Chebyshev, ConjugateGradients, Direct };

inline constexpr auto kSolveMethodWords =
    MakeEnumWords<SolveMethod>("method", {{SolveMethod::Progressive, "progressive"},
                                          {SolveMethod::Weighted, "weighted"},
                                          {SolveMethod::Chebyshev, "chebyshev"},
                                          {SolveMethod::ConjugateGradients, "cg"},
                                          {SolveMethod::Direct, "direct"},
                                          {SolveMethod::Automatic, "auto"}});

constexpr char const* GetName(SolveMethod method) {
    return kSolveMethodWords.GetWord(method);
}

struct InterpolateOptions {
    SolveMethod method = SolveMethod::Automatic;
    double tolerance = 1e-6;   ///< of max |M - A P| over the diagonal of M's bounding box
    int maxIterations = 1000;  ///< applications of A
    double lambdaMin =
        0.0;  ///< a lower bound of A's eigenvalues if one is known; 0: limn finds its own
    OnIteration onIteration{};
    FixedTable const* table = nullptr;  ///< of MakeTable: what iterations apply, in float
};

/// A component on which A is singular (see SingularComponents).
struct SingularReport {
    Index firstVertex = 0, numVertices = 0;
    double defect = 0.0;    ///< what no P can reach, over the diagonal of M's bounding box
    bool isSolved = false;  ///< the defect is below the tolerance, the rest solved to what is left
};

/// How a solve went. Not converging is an answer: the solution is then the best there is.
struct SolveReport {
    SolveMethod method = SolveMethod::Automatic;  ///< the last one used
    int iterations = 0;                           ///< applications of A, all channels at once
    double residual = 0.0;                        ///< max |M - A P| over the diagonal, in double
    Index worstVertex = -1;                       ///< where that is, if the solve did not converge
    std::vector<double> history;                  ///< residual at each application
    bool converged = false;
    double lambdaMin = 0.0;  ///< lower bound used or smallest eigenvalue found; 0: none was needed
    std::vector<SingularReport> singularComponents;
};

/// Finds control points P whose limit points are given: A P = M, for positions or any other values.
///
/// Shape    M and P: one row of `length` numbers per vertex of the level.
/// Open     boundaries and infinitely sharp creases are solved first, each curve by itself; the
///          rest follows.
/// Singular components get the solution of minimum norm where M lies within the tolerance of A's
/// range.
/// Threads  immutable; Solve may be called from several threads, and gives the same bits for any
///          pool size.
/// Source   [LaiCheng11] Sec. 4, eq. (5) and (7); [Limit 5], [Limit 6].
class Interpolator {
public:
    /// \throws Error  as LimitOperator::Build
    explicit Interpolator(Far::TopologyRefiner const& refiner, int level = 0,
                          far_ext::LimitOptions const& options = {});

    /// A, its rows in the order of GetVertices.
    LimitOperator const& GetOperator() const { return _operator; }

    /// Per row of A the vertex it belongs to.
    std::vector<Index> const& GetVertices() const { return _vertices; }

    /// Limits of all vertices: A times rows of `length` numbers, one per vertex.
    std::vector<double> FindLimits(std::span<double const> values, int length) const;

    /// A as a table of an evaluator, named LimitApplication::kTable, its rows in the order of
    /// GetVertices.
    FixedTable MakeTable(TableEvaluator& evaluator) const;

    /// \param M       rows of `length` numbers, any length
    /// \param P       receives the solution; must not overlap M
    /// \throws Error  BadMesh: a number of M that is not finite (vertex named).  BadOption: sizes
    ///                or options that do not fit.  Also what onIteration throws
    SolveReport Solve(std::span<double const> M, int length, std::span<double> P,
                      InterpolateOptions const& options = {}) const;

    /// Smallest eigenvalue of A (of its rest, see LimitOperator) from some steps of Lanczos'
    /// method: from above, within a few percent, alternating modes of singular components aside. 1
    /// where there is no rest.
    double EstimateSmallestEigenvalue(int steps = 40) const;

private:
    double ChooseLambda(InterpolateOptions const& options) const;
    SolveReport SolveBlock(LimitProblem& problem, InterpolateOptions const& options) const;
    IterationResult Run(LimitProblem const& problem, InterpolateOptions const& options,
                        SolveMethod& used) const;

    Index FindFirstVertex(SingularComponents::Component const& component) const;

    std::vector<Index> _vertices;  // before what it is needed for
    LimitOperator _operator;
    SingularComponents _singular;
};

/// Diagonal of the bounding box of rows of `length` numbers; 1 if all rows are equal.
double FindSize(std::span<double const> values, int length);

}  // namespace limn::eval
