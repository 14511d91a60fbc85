// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/SparseCore>

namespace limn::eval {

/// Nested dissection by METIS, as an ordering for Eigen's factorisations: of meshes it leaves less
/// fill than minimum degree. In place of Eigen::MetisOrdering, whose way into METIS puts handlers
/// on SIGTERM and SIGABRT for as long as it takes: they are for the calling thread alone, and a
/// signal that another one gets makes them jump to nowhere.
///
/// Threads  One ordering at a time: METIS draws from the process's rand(), which it seeds each
/// time.
class DissectionOrdering {
public:
    using PermutationType = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;

    /// \param matrix  symmetric, both triangles
    /// \throws std::bad_alloc
    void operator()(Eigen::SparseMatrix<double> const& matrix, PermutationType& order) const;
};

}  // namespace limn::eval
