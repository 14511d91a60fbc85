// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/maps/map_colours.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace limn::engine {

namespace {

constexpr int kMargin = 8, kLineHeight = 20;

bool IsCount(MapTraits const& map) {
    return map.GetGroups().front().averaging == Averaging::Count;
}

}  // namespace

MapColours::MapColours(MapTraits map, std::optional<PreviewRange> const& range,
                       Encoding const& encoding)
    : _map(std::move(map)), _range(range), _encoding(encoding) {}

/// Vectors and colours show their three components; anything else its first channel.
bool MapColours::IsColour() const {
    return _map.range == RangeKind::Vector || _map.range == RangeKind::UnitVector ||
           _map.range == RangeKind::Line || _map.range == RangeKind::Colours;
}

/// Percentiles would cut a cloud of positions, and leave of counts nothing but ones.
PreviewRange::Rule MapColours::GetRule() const {
    if (_range) return _range->rule;
    bool const isWhole = _map.range == RangeKind::Vector || IsCount(_map);
    return isWhole ? PreviewRange::Rule::Full : PreviewRange::Rule::Percentiles;
}

float MapColours::Decode(float value) const {
    if (_encoding.scale == 0.0) return value;
    float const decoded =
        static_cast<float>((static_cast<double>(value) - _encoding.offset) / _encoding.scale);
    return _map.range == RangeKind::Line ? std::abs(decoded) : decoded;  // a line's sign is free
}

void MapColours::Add(int channel, float value) {
    float const decoded = Decode(value);
    _values[channel].Add(decoded);
    _magnitudes[channel].Add(std::abs(decoded));
}

void MapColours::Prepare() {
    for (int c = 0; c < GetNumShown(); ++c) _scales[c] = FindScale(c);
}

ColourScale MapColours::FindScale(int channel) const {
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

Colour MapColours::FindColour(std::array<float, 3> const& values) const {
    auto const share = [&](int c) { return _scales[c].ToShare(Decode(values[c])); };
    if (IsColour()) return {share(0), share(1), share(2)};
    return _scales[0].ToColour(Decode(values[0]));
}

/// "mean, 1/length", or "curvature: k1, 1/length" where one of several channels is shown.
std::string MapColours::DescribeMap() const {
    std::string text = _map.name;
    if (HasColours() && _map.GetNumChannels() > GetNumShown()) text += ": " + _map.channels.front();
    return _map.units == "none" ? text : text + ", " + _map.units;
}

/// Lines of text: the map with its unit, what it is of, and what its colours mean where no bar can
/// tell.
std::vector<std::string> MapColours::Describe(std::string const& of) const {
    std::vector<std::string> lines{DescribeMap(), of};
    if (!HasColours()) lines.push_back("streaks along the flow");
    if (_map.range == RangeKind::UnitVector) lines.push_back("R, G, B: x, y, z from -1 to 1");
    if (_map.range == RangeKind::Line) lines.push_back("R, G, B: x, y, z without sign");
    for (int c = 0; c < 3 && _map.range == RangeKind::Vector; ++c) {
        lines.push_back(
            fmt::format("{}: {:.4g} to {:.4g}", "RGB"[c], _scales[c].low, _scales[c].high));
    }
    if (IsColour() || !HasColours()) return lines;
    if (_scales[0].IsConstant()) lines.push_back(fmt::format("{:.3g} everywhere", _scales[0].low));
    if (_scales[0].linear > 0.0f)
        lines.push_back(fmt::format("asinh, linear up to {:.3g}", _scales[0].linear));
    return lines;
}

Picture MapColours::DrawLegend(std::string const& of, int leastWidth) const {
    auto const lines = Describe(of);
    int width = leastWidth;
    for (auto const& line : lines)
        width = std::max(width, Picture::GetTextWidth(line) + 2 * kMargin);
    int const textHeight = kLineHeight * static_cast<int>(lines.size());
    Picture picture(width, textHeight + 2 * kMargin + (HasBar() ? ColourScale::kBarHeight : 0));
    int y = kMargin;
    for (auto const& line : lines) {
        picture.Write(kMargin, y, line);
        y += kLineHeight;
    }
    if (HasBar()) _scales[0].DrawBar(y, picture);
    return picture;
}

}  // namespace limn::engine
