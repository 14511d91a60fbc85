// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/preview.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/images/line_convolution.h"

namespace limn::engine {

namespace {

constexpr int kLongestFlow = 1024;  // cells
constexpr int kMargin = 8, kLineHeight = 20, kLeastWidth = 320;

bool IsCount(MapTraits const& map) {
    return map.GetGroups().front().averaging == Averaging::Count;
}

}  // namespace

Preview::Preview(MapTraits const& map, int firstChannel, int width, int height,
                 std::optional<PreviewRange> const& range, Encoding const& encoding)
    : _map(map),
      _firstChannel(firstChannel),
      _width(width),
      _height(height),
      _range(range),
      _encoding(encoding),
      _edgesOfRow(static_cast<size_t>(height)),
      _factor(std::max(1, (std::max(width, height) + kLongestFlow - 1) / kLongestFlow)),
      _flowWidth((width + _factor - 1) / _factor),
      _flowHeight((height + _factor - 1) / _factor) {
    if (map.range != RangeKind::Flow) return;
    _isInside.resize(static_cast<size_t>(_flowWidth) * _flowHeight);
    _flow.resize(2 * _isInside.size());
}

/// Vectors and colours show their three components; anything else its first channel.
bool Preview::IsColour() const {
    return _map.range == RangeKind::Vector || _map.range == RangeKind::UnitVector ||
           _map.range == RangeKind::Line || _map.range == RangeKind::Colours;
}

/// Percentiles would cut a cloud of positions, and leave of counts nothing but ones.
PreviewRange::Rule Preview::GetRule() const {
    if (_range) return _range->rule;
    bool const isWhole = _map.range == RangeKind::Vector || IsCount(_map);
    return isWhole ? PreviewRange::Rule::Full : PreviewRange::Rule::Percentiles;
}

float Preview::Decode(float value) const {
    if (_encoding.scale == 0.0) return value;
    float const decoded =
        static_cast<float>((static_cast<double>(value) - _encoding.offset) / _encoding.scale);
    return _map.range == RangeKind::Line ? std::abs(decoded) : decoded;  // a line's sign is free
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
            if (!(texels.coverage[x] > 0.0f)) continue;
            float const value = Decode(values[x]);
            _values[c].Add(value);
            _magnitudes[c].Add(std::abs(value));
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
        _flow[2 * cell] += Decode(u[x]) * static_cast<float>(_width);
        _flow[2 * cell + 1] -= Decode(v[x]) * static_cast<float>(_height);
    }
}

void Preview::Prepare() {
    if (!NeedsValues()) {
        _streaks = ConvolveLines(_flowWidth, _flowHeight, _flow, _isInside);
        return;
    }
    for (int c = 0; c < GetNumShown(); ++c) _scales[c] = FindScale(c);
}

ColourScale Preview::FindScale(int channel) const {
    constexpr double kFirst = 0.01, kLast = 0.99;
    ColourScale scale{.isSigned = _map.range == RangeKind::Signed};
    auto const between = [&](double low, double high) {
        scale.low = static_cast<float>(low);
        scale.high = static_cast<float>(high);
        return scale;
    };
    if (_map.range == RangeKind::UnitVector) return between(-1.0, 1.0);
    if (_map.range == RangeKind::Line || _map.range == RangeKind::Colours) return between(0.0, 1.0);
    ValueHistogram const &values = _values[channel], &magnitudes = _magnitudes[channel];
    if (values.GetCount() == 0) return scale;
    PreviewRange::Rule const rule = GetRule();
    if (rule == PreviewRange::Rule::Given) return between(_range->low, _range->high);
    if (_map.limits) return between((*_map.limits)[0], (*_map.limits)[1]);
    bool const isCut = rule == PreviewRange::Rule::Percentiles;
    between(isCut ? values.FindQuantile(kFirst) : values.GetMin(),
            isCut ? values.FindQuantile(kLast) : values.GetMax());
    if (scale.isSigned) {
        scale.high = std::max(std::abs(scale.low), std::abs(scale.high));
        scale.low = -scale.high;
    }
    if (rule == PreviewRange::Rule::Asinh) scale.linear = magnitudes.FindQuantile(0.5);
    return scale;
}

Colour Preview::FindColour(int x, std::array<float const*, 3> const& values) const {
    if (!NeedsValues()) return {};
    auto const share = [&](int c) { return _scales[c].ToShare(Decode(values[c][x])); };
    if (IsColour()) return {share(0), share(1), share(2)};
    return _scales[0].ToColour(Decode(values[0][x]));
}

void Preview::DrawRow(int row, std::array<float const*, 3> const& values, uint8_t* rgb) const {
    std::fill_n(rgb, 3 * static_cast<size_t>(_width), kPictureBackground);
    auto const& edges = _edgesOfRow[row];
    for (size_t run = 0; run < edges.size(); run += 2) {
        int const end = run + 1 < edges.size() ? edges[run + 1] : _width;
        for (int x = edges[run]; x < end; ++x) {
            uint8_t* const pixel = rgb + 3 * static_cast<size_t>(x);
            if (NeedsValues()) {
                std::ranges::copy(ToBytes(FindColour(x, values)), pixel);
            } else {
                size_t const cell = static_cast<size_t>(row / _factor) * _flowWidth +
                                    static_cast<size_t>(x / _factor);
                std::fill_n(pixel, 3, _streaks[cell]);
            }
        }
    }
}

/// Lines of text: the map with its unit, what it is of, and what its colours mean where no bar can
/// tell.
std::vector<std::string> Preview::Describe(std::string const& of) const {
    bool const hasUnits = _map.units != "none";
    std::vector<std::string> lines{_map.name + (hasUnits ? ", " + _map.units : ""), of};
    if (_map.GetNumChannels() > GetNumShown() && NeedsValues())
        lines[0] = _map.name + ": " + _map.channels.front() + (hasUnits ? ", " + _map.units : "");
    if (_map.range == RangeKind::Flow) lines.push_back("streaks along the flow");
    if (_map.range == RangeKind::UnitVector) lines.push_back("R, G, B: x, y, z from -1 to 1");
    if (_map.range == RangeKind::Line) lines.push_back("R, G, B: x, y, z without sign");
    for (int c = 0; c < 3 && _map.range == RangeKind::Vector; ++c) {
        lines.push_back(
            fmt::format("{}: {:.4g} to {:.4g}", "RGB"[c], _scales[c].low, _scales[c].high));
    }
    if (IsColour() || !NeedsValues()) return lines;
    if (_scales[0].IsConstant()) lines.push_back(fmt::format("{:.3g} everywhere", _scales[0].low));
    if (_scales[0].linear > 0.0f)
        lines.push_back(fmt::format("asinh, linear up to {:.3g}", _scales[0].linear));
    return lines;
}

Picture Preview::DrawLegend(std::string const& of) const {
    bool const hasBar = !IsColour() && NeedsValues() && !_scales[0].IsConstant();
    auto const lines = Describe(of);
    int width = kLeastWidth;
    for (auto const& line : lines)
        width = std::max(width, Picture::GetTextWidth(line) + 2 * kMargin);
    int const textHeight = kLineHeight * static_cast<int>(lines.size());
    Picture picture(width, textHeight + 2 * kMargin + (hasBar ? ColourScale::kBarHeight : 0));
    int y = kMargin;
    for (auto const& line : lines) {
        picture.Write(kMargin, y, line);
        y += kLineHeight;
    }
    if (hasBar) _scales[0].DrawBar(y, picture);
    return picture;
}

}  // namespace limn::engine
