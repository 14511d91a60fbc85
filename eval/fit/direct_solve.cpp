// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>

#include "eval/fit/limit_problem.h"
#include "far_ext/error.h"

namespace limn::eval {

namespace {

using Stage = LimitOperator::Stage;
using Matrix = Eigen::SparseMatrix<double>;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>;

/// D A of the rows of one stage, and D M less what the known vertices contribute.
struct System {
    std::vector<Index> unknowns;  // their rows
    Matrix matrix;
    Rows right;
};

System MakeSystem(LimitProblem const& problem, Stage stage, std::vector<Index> const& pinned) {
    LimitOperator const& A = problem.A;
    System system;
    std::vector<int> place(A.GetNumVertices(), -1);
    for (Index row : pinned) place[row] = -2;
    for (Index row = 0; row < A.GetNumVertices(); ++row) {
        if (A.GetClass(row).stage != stage || place[row] == -2) continue;
        place[row] = static_cast<int>(system.unknowns.size());
        system.unknowns.push_back(row);
    }
    Eigen::Index const size = static_cast<Eigen::Index>(system.unknowns.size());
    system.right.resize(size, problem.length);
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index i = 0; i < size; ++i) {
        Index const row = system.unknowns[i];
        double const scale = A.GetClass(row).scale;
        for (int c = 0; c < problem.length; ++c)
            system.right(i, c) = scale * problem.GetData(row)[c];
        A.ForEachEntry(row, [&](Index column, double weight) {
            if (place[column] >= 0) {
                entries.emplace_back(static_cast<int>(i), place[column], scale * weight);
            } else if (place[column] == -1) {
                for (int c = 0; c < problem.length; ++c)
                    system.right(i, c) -= scale * weight * problem.GetSolution(column)[c];
            }
        });
    }
    system.matrix.resize(size, size);
    system.matrix.setFromTriplets(entries.begin(), entries.end());
    return system;
}

/// Writes the solution back, or tells that the factorisation failed.
template <class Solver>
bool SolveWith(Solver& solver, System const& system, LimitProblem const& problem) {
    solver.compute(system.matrix);
    if (solver.info() != Eigen::Success) return false;
    Rows const solution = solver.solve(system.right);
    for (Eigen::Index i = 0; i < solution.rows(); ++i) {
        double* const row = problem.GetSolution(system.unknowns[i]);
        for (int c = 0; c < problem.length; ++c) row[c] = solution(i, c);
    }
    return true;
}

bool HasValence2(LimitOperator const& A) {
    for (Index row = 0; row < A.GetNumVertices(); ++row) {
        if (A.GetClass(row).kind == far_ext::LimitRow::Kind::Smooth &&
            A.GetClass(row).numEdges == 2)
            return true;
    }
    return false;
}

}  // namespace

void SolveCurves(LimitProblem const& problem) {
    for (Index row = 0; row < problem.A.GetNumVertices(); ++row) {
        if (problem.A.GetClass(row).stage != Stage::Fixed) continue;
        std::copy_n(problem.GetData(row), problem.length, problem.GetSolution(row));
    }
    if (problem.A.GetNumRows(Stage::Curve) == 0) return;
    System const system = MakeSystem(problem, Stage::Curve, {});
    Eigen::SimplicialLLT<Matrix> solver;  // (1,4,1)/6: diagonally dominant
    SolveWith(solver, system, problem);
}

IterationResult SolveDirectly(LimitProblem const& problem, std::vector<Index> const& pinned) {
    for (Index row : pinned) std::fill_n(problem.GetSolution(row), problem.length, 0.0);
    System const system = MakeSystem(problem, Stage::Rest, pinned);
    bool isSolved = false;
    if (problem.A.IsSymmetric() && !HasValence2(problem.A)) {
        Eigen::SimplicialLDLT<Matrix> solver;
        isSolved = SolveWith(solver, system, problem);
    } else {
        Eigen::SparseLU<Matrix> solver;
        isSolved = SolveWith(solver, system, problem);
    }
    IterationResult result;
    result.applications = 1;
    result.residual = FindResidual(problem);
    result.history = {result.residual};
    result.isStuck = !isSolved;
    result.converged = isSolved && result.residual <= problem.tolerance;
    return result;
}

}  // namespace limn::eval
