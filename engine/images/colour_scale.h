// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/images/picture.h"

namespace limn::engine {

/// Which colour is which value: diverging colours for signed values, of which the middle is white,
/// else sequential ones.
struct ColourScale {
    bool isSigned = false;
    float low = 0.0f, high = 0.0f;
    float linear = 0.0f;  ///< values are stretched by asinh(value / linear); 0: not at all

    bool IsConstant() const { return !(low < high); }

    /// How far between low and high a value is; beyond them below 0 or above 1.
    float ToShare(float value) const;
    Colour ToColour(float value) const { return FromShare(ToShare(value)); }

    static constexpr int kBarHeight = 28;
    /// A bar of all colours across the picture from row y on, between the figures of low and high.
    void DrawBar(int y, Picture& picture) const;

private:
    Colour FromShare(float share) const;
    float Stretch(float value) const;
};

}  // namespace limn::engine
