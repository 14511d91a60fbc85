// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "eval/cascade/cascade_operator.h"

namespace limn::eval {

// Sweeps run on the calling arena's threads, for all unknowns; rows that stay are not written.

/// Damping of the Jacobi sweep.
inline constexpr double kJacobiDamping = 0.75;

/// One damped Jacobi sweep, to = X - theta D^-1 ((M + L) X - M X0).
void SweepJacobi(far_ext::CascadeLevel const& level, CascadeOperator<float> const& op,
                 CascadeRows<float> const& x, CascadeRows<float> const& x0, CascadeRows<float>& to);
void SweepJacobi(far_ext::CascadeLevel const& level, CascadeOperator<double> const& op,
                 CascadeRows<double> const& x, CascadeRows<double> const& x0,
                 CascadeRows<double>& to);

/// `count` sweeps, from x to `odd`, from there to `even`, from there to `odd`, and so on: the same
/// bits as one after another, but large levels are passed through once for every few sweeps, each
/// close behind the one before.
///
/// \param odd, even  rows that stay are in place; even may be x
void SweepJacobi(far_ext::CascadeLevel const& level, CascadeOperator<float> const& op,
                 CascadeRows<float> const& x, CascadeRows<float> const& x0, CascadeRows<float>& odd,
                 CascadeRows<float>& even, int count);
void SweepJacobi(far_ext::CascadeLevel const& level, CascadeOperator<double> const& op,
                 CascadeRows<double> const& x, CascadeRows<double> const& x0,
                 CascadeRows<double>& odd, CascadeRows<double>& even, int count);

}  // namespace limn::eval
