// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/preview.h"

#include <algorithm>

#include "engine/images/line_convolution.h"

namespace limn::engine {

namespace {

constexpr int kLongestFlow = 1024;  // cells

}  // namespace

Preview::Preview(MapTraits const& map, int firstChannel, int width, int height,
                 std::optional<PreviewRange> const& range, Encoding const& encoding)
    : _colours(map, range, encoding),
      _firstChannel(firstChannel),
      _width(width),
      _height(height),
      _edgesOfRow(static_cast<size_t>(height)),
      _factor(std::max(1, (std::max(width, height) + kLongestFlow - 1) / kLongestFlow)),
      _flowWidth((width + _factor - 1) / _factor),
      _flowHeight((height + _factor - 1) / _factor) {
    if (NeedsValues()) return;
    _isInside.resize(static_cast<size_t>(_flowWidth) * _flowHeight);
    _flow.resize(2 * _isInside.size());
}

void Preview::Add(int row, TexelRowView const& texels) {
    auto& edges = _edgesOfRow[row];
    for (int x = 0; x < _width; ++x) {
        bool const wasFilled = edges.size() % 2 == 1;
        if (wasFilled != static_cast<bool>(texels.isFilled[x])) edges.push_back(x);
    }
    if (!NeedsValues()) return AddFlow(row, texels);
    for (int c = 0; c < GetNumShown(); ++c) {
        float const* const values =
            texels.values + static_cast<size_t>(_firstChannel + c) * texels.stride;
        for (int x = 0; x < _width; ++x) {
            if (texels.coverage[x] > 0.0f) _colours.Add(c, values[x]);
        }
    }
}

void Preview::AddFlow(int row, TexelRowView const& texels) {
    float const* const u = texels.values + static_cast<size_t>(_firstChannel) * texels.stride;
    float const* const v = u + texels.stride;
    size_t const first = static_cast<size_t>(row / _factor) * _flowWidth;
    for (int x = 0; x < _width; ++x) {
        if (!texels.isFilled[x]) continue;
        size_t const cell = first + static_cast<size_t>(x / _factor);
        _isInside[cell] = 1;
        // Texture coordinates to texels, v upwards.
        _flow[2 * cell] += _colours.Decode(u[x]) * static_cast<float>(_width);
        _flow[2 * cell + 1] -= _colours.Decode(v[x]) * static_cast<float>(_height);
    }
}

void Preview::Prepare() {
    if (NeedsValues())
        _colours.Prepare();
    else
        _streaks = ConvolveLines(_flowWidth, _flowHeight, _flow, _isInside);
}

void Preview::DrawRow(int row, std::array<float const*, 3> const& values, uint8_t* rgb) const {
    std::fill_n(rgb, 3 * static_cast<size_t>(_width), kPictureBackground);
    auto const& edges = _edgesOfRow[row];
    for (size_t run = 0; run < edges.size(); run += 2) {
        int const end = run + 1 < edges.size() ? edges[run + 1] : _width;
        for (int x = edges[run]; x < end; ++x) {
            uint8_t* const pixel = rgb + 3 * static_cast<size_t>(x);
            if (NeedsValues()) {
                std::array<float, 3> texel{};
                for (int c = 0; c < GetNumShown(); ++c) texel[c] = values[c][x];
                std::ranges::copy(ToBytes(_colours.FindColour(texel)), pixel);
            } else {
                size_t const cell = static_cast<size_t>(row / _factor) * _flowWidth +
                                    static_cast<size_t>(x / _factor);
                std::fill_n(pixel, 3, _streaks[cell]);
            }
        }
    }
}

}  // namespace limn::engine
