// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/fit/morph.h"

namespace limn::engine {

/// Most steps of a schedule: frames have numbers of four digits.
inline constexpr int kMaxMorphSteps = 9999;

/// The steps of a table `step,detail,rate`, whose steps are 1, 2, ... in order.
///
/// \throws Error  BadMesh, as "FILE:LINE: ...": another order, a detail that is no whole number
/// from
///                0 to 1000, a rate that is not between 0 and 1, no row or too many.  Io
std::vector<MorphStep> ReadMorphSchedule(std::string const& path);

}  // namespace limn::engine
