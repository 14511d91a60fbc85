// SPDX-License-Identifier: Apache-2.0
#include "engine/images/colours.h"

#include <algorithm>

namespace limn::engine {

namespace {

/// A ramp through equally spaced colours, at t in [0, 1].
template <size_t N>
Colour GetRampColour(std::array<Colour, N> const& stops, float t) {
    float const at = std::clamp(t, 0.0f, 1.0f) * (N - 1);
    size_t const low = std::min(static_cast<size_t>(at), N - 2);
    float const f = at - static_cast<float>(low);
    Colour colour;
    for (size_t c = 0; c < 3; ++c) {
        colour[c] = stops[low][c] + f * (stops[low + 1][c] - stops[low][c]);
    }
    return colour;
}

}  // namespace

Colour GetDivergingColour(float t) {
    static constexpr std::array<Colour, 5> kStops{{{0.02f, 0.19f, 0.45f},
                                                   {0.26f, 0.58f, 0.77f},
                                                   {0.97f, 0.97f, 0.97f},
                                                   {0.90f, 0.45f, 0.32f},
                                                   {0.45f, 0.02f, 0.10f}}};
    return GetRampColour(kStops, 0.5f + 0.5f * t);
}

Colour GetSequentialColour(float t) {
    static constexpr std::array<Colour, 5> kStops{{{0.27f, 0.00f, 0.33f},
                                                   {0.23f, 0.32f, 0.55f},
                                                   {0.13f, 0.57f, 0.55f},
                                                   {0.37f, 0.79f, 0.38f},
                                                   {0.99f, 0.91f, 0.14f}}};
    return GetRampColour(kStops, t);
}

}  // namespace limn::engine
