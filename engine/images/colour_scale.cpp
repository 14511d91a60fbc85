// SPDX-License-Identifier: Apache-2.0
#include "engine/images/colour_scale.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

namespace limn::engine {

float ColourScale::Stretch(float value) const {
    return linear > 0.0f ? std::asinh(value / linear) : value;
}

float ColourScale::ToShare(float value) const {
    float const first = Stretch(low), last = Stretch(high);
    return last > first ? (Stretch(value) - first) / (last - first) : 0.5f;
}

Colour ColourScale::FromShare(float share) const {
    return isSigned ? GetDivergingColour(2 * share - 1) : GetSequentialColour(share);
}

void ColourScale::DrawBar(int y, Picture& picture) const {
    constexpr int kMargin = 8, kGap = 4, kTextHeight = 14;
    std::string const left = fmt::format("{:.3g}", low), right = fmt::format("{:.3g}", high);
    int const textY = y + (kBarHeight - kTextHeight) / 2;
    int const rightX = picture.GetWidth() - kMargin - Picture::GetTextWidth(right);
    int const begin = kMargin + Picture::GetTextWidth(left) + kGap, end = rightX - 2 * kGap;
    picture.Write(kMargin, textY, left);
    picture.Write(rightX, textY, right);
    for (int x = begin; x < end; ++x) {
        float const share =
            static_cast<float>(x - begin) / static_cast<float>(std::max(1, end - begin - 1));
        for (int row = 0; row < kTextHeight; ++row) picture.Set(x, textY + row, FromShare(share));
    }
}

}  // namespace limn::engine
