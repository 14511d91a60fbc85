// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "eval/cascade/cascade_operator.h"
#include "far_ext/rows/sparse_rows.h"

namespace limn::eval {

/// A damped Jacobi sweep as a pair of matrices: X' = sweep X + load X0, sweep = 1 - theta D^-1 (M +
/// L) and load = theta D^-1 M.
///
/// Shape   n x n each, for the n vertices of a level; rows of both together add up to 1.
/// Stays   What nothing moves has nothing of X and all of X0.
/// Source  [Diewald02] Sec. 7
struct SweepMatrices {
    far_ext::SparseRows sweep, load;
};

/// Over the rows of the level.
template <class Scalar>
SweepMatrices MakeSweepMatrices(far_ext::CascadeLevel const& level,
                                CascadeOperator<Scalar> const& op);

/// The same over its vertices, with the columns of a row in order.
SweepMatrices ToPublicOrder(far_ext::CascadeLevel const& level, SweepMatrices const& ofRows);

}  // namespace limn::eval
