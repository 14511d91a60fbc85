// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <HYPRE.h>
#include <HYPRE_krylov.h>
#include <HYPRE_parcsr_ls.h>
#include <mpi.h>

#include "peers/pinned_laplacian.h"

namespace limn::bench {

/// hypre's conjugate gradients preconditioned by BoomerAMG, one process. The matrix is handed over
/// beforehand; Solve sets up once and solves one right-hand side after another.
class HypreLaplacian {
public:
    explicit HypreLaplacian(PinnedLaplacian const& problem) : _problem(problem) {
        int isRunning = 0;
        MPI_Initialized(&isRunning);
        if (!isRunning) MPI_Init(nullptr, nullptr);
        HYPRE_Init();
        auto const last = static_cast<HYPRE_BigInt>(problem.matrix.rows()) - 1;
        HYPRE_IJMatrixCreate(MPI_COMM_WORLD, 0, last, 0, last, &_matrix);
        HYPRE_IJMatrixSetObjectType(_matrix, HYPRE_PARCSR);
        HYPRE_IJMatrixInitialize(_matrix);
        std::vector<HYPRE_BigInt> columns;
        for (HYPRE_BigInt row = 0; row <= last; ++row) {
            int const begin = problem.matrix.outerIndexPtr()[row],
                      end = problem.matrix.outerIndexPtr()[row + 1];
            columns.assign(problem.matrix.innerIndexPtr() + begin,
                           problem.matrix.innerIndexPtr() + end);
            HYPRE_Int count = end - begin;
            HYPRE_IJMatrixSetValues(_matrix, 1, &count, &row, columns.data(),
                                    problem.matrix.valuePtr() + begin);
        }
        HYPRE_IJMatrixAssemble(_matrix);
        for (HYPRE_BigInt row = 0; row <= last; ++row) _rows.push_back(row);
    }
    ~HypreLaplacian() { HYPRE_IJMatrixDestroy(_matrix); }
    HypreLaplacian(HypreLaplacian const&) = delete;
    HypreLaplacian& operator=(HypreLaplacian const&) = delete;

    Eigen::MatrixX3d Solve(double tolerance) const {
        HYPRE_ParCSRMatrix matrix;
        HYPRE_IJMatrixGetObject(_matrix, reinterpret_cast<void**>(&matrix));
        HYPRE_Solver solver, amg;
        HYPRE_BoomerAMGCreate(&amg);
        HYPRE_BoomerAMGSetPrintLevel(amg, 0);
        HYPRE_BoomerAMGSetCoarsenType(
            amg, 8);  // PMIS, extended interpolation: fastest of those tried in two dimensions
        HYPRE_BoomerAMGSetInterpType(amg, 6);
        HYPRE_BoomerAMGSetRelaxType(amg, 6);
        HYPRE_BoomerAMGSetNumSweeps(amg, 1);
        HYPRE_BoomerAMGSetTol(amg, 0.0);
        HYPRE_BoomerAMGSetMaxIter(amg, 1);
        HYPRE_ParCSRPCGCreate(MPI_COMM_WORLD, &solver);
        HYPRE_PCGSetMaxIter(solver, 500);
        HYPRE_PCGSetTol(solver, tolerance);
        HYPRE_PCGSetTwoNorm(solver, 1);
        HYPRE_PCGSetPrecond(solver, reinterpret_cast<HYPRE_PtrToSolverFcn>(HYPRE_BoomerAMGSolve),
                            reinterpret_cast<HYPRE_PtrToSolverFcn>(HYPRE_BoomerAMGSetup), amg);
        Eigen::MatrixX3d result(_problem.matrix.rows(), 3);
        for (Index c = 0; c < 3; ++c) {
            Eigen::VectorXd const zero = Eigen::VectorXd::Zero(result.rows());
            HYPRE_IJVector const b = MakeVector(_problem.rightSide.col(c).data()),
                                 x = MakeVector(zero.data());
            HYPRE_ParVector right, left;
            HYPRE_IJVectorGetObject(b, reinterpret_cast<void**>(&right));
            HYPRE_IJVectorGetObject(x, reinterpret_cast<void**>(&left));
            if (c == 0) HYPRE_ParCSRPCGSetup(solver, matrix, right, left);
            HYPRE_ParCSRPCGSolve(solver, matrix, right, left);
            HYPRE_IJVectorGetValues(x, static_cast<HYPRE_Int>(_rows.size()), _rows.data(),
                                    result.col(c).data());
            HYPRE_IJVectorDestroy(b);
            HYPRE_IJVectorDestroy(x);
        }
        HYPRE_ParCSRPCGDestroy(solver);
        HYPRE_BoomerAMGDestroy(amg);
        return result;
    }

private:
    HYPRE_IJVector MakeVector(double const* values) const {
        HYPRE_IJVector vector;
        HYPRE_IJVectorCreate(MPI_COMM_WORLD, 0, _rows.back(), &vector);
        HYPRE_IJVectorSetObjectType(vector, HYPRE_PARCSR);
        HYPRE_IJVectorInitialize(vector);
        HYPRE_IJVectorSetValues(vector, static_cast<HYPRE_Int>(_rows.size()), _rows.data(), values);
        HYPRE_IJVectorAssemble(vector);
        return vector;
    }

    PinnedLaplacian const& _problem;
    HYPRE_IJMatrix _matrix;
    std::vector<HYPRE_BigInt> _rows;
};

}  // namespace limn::bench
