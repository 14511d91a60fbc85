// SPDX-License-Identifier: Apache-2.0
#include "engine/io/colour_range.h"

#include <algorithm>
#include <cmath>

namespace limn::engine {

void ScaleWholeColours(std::vector<float>& values) {
    bool const areBytes = std::all_of(values.begin(), values.end(), [](float value) {
        return value >= 0.0f && value <= 255.0f && value == std::floor(value);
    });
    bool const areShares =
        std::all_of(values.begin(), values.end(), [](float value) { return value <= 1.0f; });
    if (!areBytes || areShares) return;
    for (float& value : values) value = static_cast<float>(value * (1.0 / 255));
}

}  // namespace limn::engine
