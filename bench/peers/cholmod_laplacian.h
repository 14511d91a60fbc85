// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/CholmodSupport>

#include "peers/pinned_laplacian.h"

namespace limn::bench {

/// CHOLMOD's supernodal factorisation with METIS's ordering: set-up and three solves.
inline Eigen::MatrixX3d SolveByCholmod(PinnedLaplacian const& problem) {
    Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>> cholmod;
    cholmod.cholmod().nmethods = 1;
    cholmod.cholmod().method[0].ordering = CHOLMOD_METIS;
    cholmod.compute(problem.matrix);
    return cholmod.solve(problem.rightSide);
}

}  // namespace limn::bench
