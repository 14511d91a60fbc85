// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace limn::engine {

/// Red, green and blue, from 0 to 1.
using Colour = std::array<float, 3>;

/// For signed values: t in [-1, 1] from blue over white, which is 0, to red. t beyond is clamped.
Colour GetDivergingColour(float t);

/// For values of one sign: t in [0, 1] from dark violet to yellow. t beyond is clamped.
Colour GetSequentialColour(float t);

}  // namespace limn::engine
