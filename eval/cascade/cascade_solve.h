// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "eval/cascade/cascade_operator.h"

namespace limn::eval {

/// What became of solving a level.
struct CascadeSolve {
    int iterations = 0;
    double residual = 0.0;  ///< |M (X0 - X) - L X|, or with L M^-1 L for L, over |M (X0 -
                            ///< centroid)|: of positions, or of widths if that is more
    bool converged = true;
};

/// |M (X0 - X) - L X| / |M (X0 - centroid)| over all unknowns, of an operator of order 2.
template <class Scalar>
double MeasureResidual(far_ext::CascadeLevel const& level, CascadeOperator<Scalar> const& op,
                       CascadeRows<Scalar> const& x, CascadeRows<Scalar> const& x0);

/// Solves (M + L) X = M X0, or (M + L M^-1 L) X = M X0, by conjugate gradients, each coordinate
/// with steps of its own. Rows on creases first: surface rows see them as given.
///
/// \param tolerance      of the residual. Above 0 the diagonal is the preconditioner; at 0 all
///                       iterations are done without one, as the a-priori counts of [Diewald02] are
///                       meant, unless only rounding is left
/// \param x              what to start from, and the result
/// \param maxIterations  of each kind of rows
/// \param progress       called between iterations with the share done, as far as one can tell; may
///                       throw
CascadeSolve SolveByConjugateGradients(far_ext::CascadeLevel const& level,
                                       CascadeOperator<double> const& op,
                                       CascadeRows<double> const& x0, CascadeRows<double>& x,
                                       int maxIterations, double tolerance,
                                       std::function<void(double)> const& progress = {});

/// The same by a sparse Cholesky factorisation: the reference.
///
/// \throws Error  BadMesh: an operator that is not positive definite
CascadeSolve SolveByCholesky(far_ext::CascadeLevel const& level, CascadeOperator<double> const& op,
                             CascadeRows<double> const& x0, CascadeRows<double>& x);

}  // namespace limn::eval
