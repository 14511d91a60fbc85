// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace limn::engine {

/// Colours in text run from 0 to 1 or, as whole numbers, from 0 to 255; nothing but the numbers
/// tells which. They come out from 0 to 1, as the bytes of a PLY do.
void ScaleWholeColours(std::vector<float>& values);

}  // namespace limn::engine
