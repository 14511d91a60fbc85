// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace limn::eval {

/// Three right-hand sides side by side, and a fourth lane that stays 0.
using FloatLanes = Eigen::Array4f;
using DoubleLanes = Eigen::Array4d;

}  // namespace limn::eval
