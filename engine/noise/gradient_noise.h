// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace limn::engine {

/// Gradient noise in space: smooth (second derivatives are continuous), 0 at whole coordinates, in
/// [-1, 1], without a preferred direction; another function for every seed. The gradients come from
/// a hash of the lattice point, everything else from basic operations on doubles: the same bits on
/// every machine.
///
/// Finite coordinates of any size are taken; beyond 2^52, where doubles are whole, the value is 0.
double GradientNoise(uint64_t seed, double x, double y, double z);

}  // namespace limn::engine
