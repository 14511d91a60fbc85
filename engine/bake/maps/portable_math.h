// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limn::engine {

/// Arctangent of y / x in all quadrants, and the binary logarithm of a positive number, from basic
/// operations only: the same bits on every CPU, accurate to 1e-7 (libm's depend on the CPU).
float PortableAtan2(float y, float x);
float PortableLog2(float x);

}  // namespace limn::engine
