// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/preview.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/images/line_convolution.h"

namespace limn::engine {

namespace {

constexpr int kLongestSide = 1024;
constexpr int kLegendHeight = 28;

/// The value that a share of them does not pass, so that a few extremes do not hide the rest.
float FindQuantile(std::vector<float> values, double share) {
    if (values.empty()) return 0.0f;
    auto const at =
        values.begin() + static_cast<ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

}  // namespace

PreviewBuilder::PreviewBuilder(RangeKind range, int numChannels, int firstChannel, int width,
                               int height, float zero)
    : _range(range),
      _numChannels(numChannels),
      _firstChannel(firstChannel),
      _factor(std::max(1, (std::max(width, height) + kLongestSide - 1) / kLongestSide)),
      _width((width + _factor - 1) / _factor),
      _height((height + _factor - 1) / _factor),
      _sourceWidth(width),
      _zero(zero),
      _sums(static_cast<size_t>(_width) * _height * numChannels, 0.0f),
      _weights(static_cast<size_t>(_width) * _height, 0.0f) {}

void PreviewBuilder::Add(int row, TexelRowView const& texels) {
    size_t const line = static_cast<size_t>(row / _factor) * _width;
    size_t const numTexels = _weights.size();
    for (int x = 0; x < _sourceWidth; ++x) {
        float const weight = texels.coverage[x];
        if (!(weight > 0.0f)) continue;
        size_t const to = line + x / _factor;
        _weights[to] += weight;
        for (int c = 0; c < _numChannels; ++c) {
            size_t const from = static_cast<size_t>(_firstChannel + c) * texels.stride;
            _sums[c * numTexels + to] += weight * texels.values[from + static_cast<size_t>(x)];
        }
    }
}

/// Vectors show their three components as colours; anything else its first channel.
bool PreviewBuilder::IsColour() const {
    return _range == RangeKind::Vector || _range == RangeKind::UnitVector ||
           _range == RangeKind::Line;
}

float PreviewBuilder::GetMean(int channel, size_t texel) const {
    float const mean = _sums[channel * _weights.size() + texel] / _weights[texel];
    return _range == RangeKind::Line ? std::abs(mean) : mean;  // a line's sign is free
}

PreviewBuilder::Limits PreviewBuilder::FindLimits() const {
    Limits limits;
    if (_range == RangeKind::UnitVector || _range == RangeKind::Line) {
        limits.low.fill(_range == RangeKind::Line ? 0.0f : -1.0f);
        limits.high.fill(1.0f);
        return limits;
    }
    bool const isSigned = _range == RangeKind::Signed, isColour = IsColour();
    for (int c = 0; c < (isColour ? 3 : 1); ++c) {
        std::vector<float> values;
        for (size_t texel = 0; texel < _weights.size(); ++texel) {
            if (!(_weights[texel] > 0.0f)) continue;
            float const value = GetMean(c, texel);
            values.push_back(isSigned ? std::abs(value) : value);
        }
        if (isSigned) {
            limits.high[c] = FindQuantile(std::move(values), 0.98);
            limits.low[c] = -limits.high[c];
        } else {
            limits.low[c] = FindQuantile(values, isColour ? 0.0 : 0.02);
            limits.high[c] = FindQuantile(std::move(values), isColour ? 1.0 : 0.98);
        }
    }
    return limits;
}

/// \param share  of the way from the low limit to the high one
Colour PreviewBuilder::ToColour(float share) const {
    return _range == RangeKind::Signed ? GetDivergingColour(2 * share - 1)
                                       : GetSequentialColour(share);
}

Picture PreviewBuilder::Draw() const {
    if (_range == RangeKind::Flow) return DrawFlow();
    Limits const limits = FindLimits();
    Picture picture(std::max(_width, 128), _height + kLegendHeight);
    auto const share = [&](int c, size_t texel) {
        float const low = limits.low[c], high = limits.high[c];
        return high > low ? (GetMean(c, texel) - low) / (high - low) : 0.5f;
    };
    for (size_t texel = 0; texel < _weights.size(); ++texel) {
        if (!(_weights[texel] > 0.0f)) continue;
        Colour const colour = IsColour() ? Colour{share(0, texel), share(1, texel), share(2, texel)}
                                         : ToColour(share(0, texel));
        picture.Set(static_cast<int>(texel) % _width, static_cast<int>(texel) / _width, colour);
    }
    DrawLegend(limits, picture);
    return picture;
}

/// Least value, ramp, largest value.
void PreviewBuilder::DrawLegend(Limits const& limits, Picture& picture) const {
    int const numShown = IsColour() ? 3 : 1;
    float const least = *std::min_element(limits.low.begin(), limits.low.begin() + numShown);
    float const most = *std::max_element(limits.high.begin(), limits.high.begin() + numShown);
    std::string const left = fmt::format("{:.3g}", least), right = fmt::format("{:.3g}", most);
    int const textY = _height + 7, rampBegin = 8 + Picture::GetTextWidth(left) + 4;
    int const rampEnd = picture.GetWidth() - 8 - Picture::GetTextWidth(right) - 8;
    picture.Write(8, textY, left);
    picture.Write(picture.GetWidth() - 8 - Picture::GetTextWidth(right), textY, right);
    for (int x = rampBegin; x < rampEnd; ++x) {
        float const t = static_cast<float>(x - rampBegin) /
                        static_cast<float>(std::max(1, rampEnd - rampBegin - 1));
        Colour const colour = IsColour() ? Colour{t, t, t} : ToColour(t);
        for (int y = 0; y < 14; ++y) picture.Set(x, textY + y, colour);
    }
}

Picture PreviewBuilder::DrawFlow() const {
    size_t const numTexels = _weights.size();
    std::vector<float> flow(2 * numTexels, 0.0f);
    std::vector<uint8_t> isInside(numTexels, 0);
    for (size_t texel = 0; texel < numTexels; ++texel) {
        if (!(_weights[texel] > 0.0f)) continue;
        isInside[texel] = 1;
        // Texture coordinates to texels, v upwards.
        flow[2 * texel] = (GetMean(0, texel) - _zero) * static_cast<float>(_width);
        flow[2 * texel + 1] = -(GetMean(1, texel) - _zero) * static_cast<float>(_height);
    }
    std::vector<uint8_t> const grey = ConvolveLines(_width, _height, flow, isInside);
    Picture picture(_width, _height);
    for (size_t pixel = 0; pixel < grey.size(); ++pixel) picture.SetGrey(pixel, grey[pixel]);
    return picture;
}

}  // namespace limn::engine
