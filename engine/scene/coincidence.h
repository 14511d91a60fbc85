// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "far_ext/types.h"

namespace limn::engine {

/// Groups points that lie in one place: equal ones, and those joined by steps of at most
/// `tolerance` from point to point. Groups do not depend on the points' numbering.
///
/// \param positions    3 per point, finite
/// \param isCandidate  per point; others coincide with nothing
/// \param tolerance    0 or more
/// \return             per point the lowest number of its group's points
/// \throws Error       BadOption: a tolerance that reaches more than 256 other places from one,
///                     so that it tells nothing apart
std::vector<Index> GroupCoincident(std::span<double const> positions,
                                   std::span<char const> isCandidate, double tolerance);

}  // namespace limn::engine
