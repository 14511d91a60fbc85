// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "eval/fit/limit_application.h"

namespace limn::eval {

/// Frequency bands of a mesh: with E - A as the high-pass filter, M = sum over i < N of (E-A)^i A
/// M, plus the remainder (E-A)^N M. All filters are applications of A; no matrix is kept.
///
/// Values   rows of `length` numbers (1 to 4) per vertex, changed in place.
/// Affine   all of these commute with translations, rotations and scaling.
/// Threads  the same bits for any pool size.
/// Source   [LaiCheng11] Sec. 3 and 6 to 7, eq. (6), (8), (9), as corrected in [Limit 7].

/// x <- (E-A)^power x.
///
/// \param visit  called with i and (E-A)^i x for i = 0 to power; may be empty
void ApplyHighPass(LimitApplication const& A, int length, int power, std::vector<double>& x,
                   std::function<void(int, std::span<double const>)> const& visit = {});

/// Bands that follow each other, each with a gain, and what lies beyond them.
struct BandGains {
    int first = 0;                          ///< band of the first gain
    std::vector<double> gains;              ///< of bands first, first + 1, ...
    std::optional<double> remainder = 1.0;  ///< of (E-A)^GetEnd(); none: that is left out

    /// The band after the last.
    int GetEnd() const { return first + static_cast<int>(gains.size()); }
};

/// x <- sum over k of gains[k] (E-A)^(first+k) A x, + remainder (E-A)^end x.
///
/// \param visit  called with i and band i from 0 on, before it is weighed, and with the end and the
///               remainder where that is taken; may be empty
void WeighBands(LimitApplication const& A, int length, BandGains const& gains,
                std::vector<double>& x,
                std::function<void(int, std::span<double const>)> const& visit = {});

/// x <- (E - (E-A)^(detail+1)) x, `steps` times: keeps the bands 0 to detail.
void Denoise(LimitApplication const& A, int length, int detail, int steps, std::vector<double>& x);

/// x <- x + sum over i = first to last of (E-A)^i x, `steps` times. \pre 0 < first <= last: the
/// constant part stays
void Sharpen(LimitApplication const& A, int length, int first, int last, int steps,
             std::vector<double>& x);

/// Q <- M + rate (E - (E-A)^(detail+1)) (Q - M): one step of the way from Q to M.
void MorphStep(LimitApplication const& A, int length, int detail, double rate,
               std::span<double const> M, std::vector<double>& Q);

/// \throws Error  BadMesh: a number that is not finite (vertex named)
void RequireFinite(std::span<double const> values, int length);

}  // namespace limn::eval
