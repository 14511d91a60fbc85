// SPDX-License-Identifier: Apache-2.0
#include "eval/forms/laplace_solver.h"

#include <Eigen/SparseCholesky>

#include "eval/forms/dissection_ordering.h"
#include "far_ext/error.h"
#include "far_ext/types.h"

namespace limn::eval {

/// The equations without the unknowns that are fixed.
class LaplaceSolver::Factorisation {
public:
    Factorisation(std::vector<char> const& isFixed,
                  std::vector<Eigen::Triplet<double>> const& entries) {
        Index count = 0;
        for (char fixed : isFixed) _places.push_back(fixed ? -1 : count++);
        _right.resize(count);
        if (count == 0) return;
        std::vector<Eigen::Triplet<double>> kept;
        kept.reserve(entries.size());
        for (auto const& entry : entries) {
            Index const row = _places[entry.row()], column = _places[entry.col()];
            if (row >= 0 && column >= 0 && row >= column)
                kept.emplace_back(row, column, entry.value());
        }
        Eigen::SparseMatrix<double> matrix(count, count);
        matrix.setFromTriplets(kept.begin(), kept.end());
        _solver.compute(matrix);
        if (_solver.info() != Eigen::Success) {
            throw Error(ErrorCode::BadMesh,
                        "the equations of this mesh have no solution in double precision: its "
                        "edges or angles "
                        "differ by too many orders of magnitude");
        }
    }

    std::vector<double> Solve(std::span<double const> right) {
        std::vector<double> result(right.size(), 0.0);
        if (_right.size() == 0) return result;
        for (size_t i = 0; i < right.size(); ++i) {
            if (_places[i] >= 0) _right[_places[i]] = right[i];
        }
        Eigen::VectorXd const solution = _solver.solve(_right);
        for (size_t i = 0; i < right.size(); ++i) {
            if (_places[i] >= 0) result[i] = solution[_places[i]];
        }
        return result;
    }

private:
    std::vector<Index> _places;
    Eigen::VectorXd _right;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, DissectionOrdering> _solver;
};

LaplaceSolver::LaplaceSolver(std::vector<char> const& isFixed,
                             std::vector<Eigen::Triplet<double>> const& entries)
    : _factorisation(std::make_unique<Factorisation>(isFixed, entries)) {}

LaplaceSolver::~LaplaceSolver() = default;

std::vector<double> LaplaceSolver::Solve(std::span<double const> right) {
    return _factorisation->Solve(right);
}

}  // namespace limn::eval
