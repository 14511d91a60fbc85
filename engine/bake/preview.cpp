// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/preview.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "engine/images/images_module.h"
#include "engine/images/line_convolution.h"
#include "engine/io/file.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

constexpr int kLongestSide = 1024;
constexpr int kLegendHeight = 28;

using Colour = std::array<float, 3>;

/// A ramp through equally spaced colours, at t in [0, 1].
template <size_t N>
Colour Ramp(std::array<Colour, N> const& stops, float t) {
    float const at = std::clamp(t, 0.0f, 1.0f) * (N - 1);
    size_t const low = std::min(static_cast<size_t>(at), N - 2);
    float const f = at - static_cast<float>(low);
    Colour colour;
    for (size_t c = 0; c < 3; ++c)
        colour[c] = stops[low][c] + f * (stops[low + 1][c] - stops[low][c]);
    return colour;
}

Colour Diverging(float t) {
    static constexpr std::array<Colour, 5> kStops{{{0.02f, 0.19f, 0.45f},
                                                   {0.26f, 0.58f, 0.77f},
                                                   {0.97f, 0.97f, 0.97f},
                                                   {0.90f, 0.45f, 0.32f},
                                                   {0.45f, 0.02f, 0.10f}}};
    return Ramp(kStops, 0.5f + 0.5f * t);
}

Colour Sequential(float t) {
    static constexpr std::array<Colour, 5> kStops{{{0.27f, 0.00f, 0.33f},
                                                   {0.23f, 0.32f, 0.55f},
                                                   {0.13f, 0.57f, 0.55f},
                                                   {0.37f, 0.79f, 0.38f},
                                                   {0.99f, 0.91f, 0.14f}}};
    return Ramp(kStops, t);
}

/// 5 x 7 dots per character, a row per byte; enough for numbers and units.
struct Glyph {
    char character;
    std::array<uint8_t, 7> rows;
};
constexpr Glyph kFont[] = {{'0', {14, 17, 19, 21, 25, 17, 14}}, {'1', {4, 12, 4, 4, 4, 4, 14}},
                           {'2', {14, 17, 1, 2, 4, 8, 31}},     {'3', {31, 2, 4, 2, 1, 17, 14}},
                           {'4', {2, 6, 10, 18, 31, 2, 2}},     {'5', {31, 16, 30, 1, 1, 17, 14}},
                           {'6', {6, 8, 16, 30, 17, 17, 14}},   {'7', {31, 1, 2, 4, 8, 8, 8}},
                           {'8', {14, 17, 17, 14, 17, 17, 14}}, {'9', {14, 17, 17, 15, 1, 2, 12}},
                           {'-', {0, 0, 0, 31, 0, 0, 0}},       {'+', {0, 4, 4, 31, 4, 4, 0}},
                           {'.', {0, 0, 0, 0, 0, 12, 12}},      {'e', {0, 0, 14, 17, 31, 16, 14}}};

class Canvas {
public:
    explicit Canvas(PreviewBuilder::Picture& picture) : _picture(picture) {}

    void Set(int x, int y, Colour const& colour) {
        if (x < 0 || y < 0 || x >= _picture.width || y >= _picture.height) return;
        uint8_t* const pixel = &_picture.pixels[3 * (static_cast<size_t>(y) * _picture.width + x)];
        for (size_t c = 0; c < 3; ++c) {
            pixel[c] = static_cast<uint8_t>(std::clamp(colour[c], 0.0f, 1.0f) * 255.0f + 0.5f);
        }
    }

    static int TextWidth(std::string const& text) { return 12 * static_cast<int>(text.size()); }

    void Text(int x, int y, std::string const& text) {
        for (char character : text) {
            for (Glyph const& glyph : kFont) {
                if (glyph.character != character) continue;
                for (int row = 0; row < 14; ++row) {
                    for (int column = 0; column < 10; ++column) {
                        if (glyph.rows[row / 2] >> (4 - column / 2) & 1)
                            Set(x + column, y + row, {1, 1, 1});
                    }
                }
            }
            x += 12;
        }
    }

private:
    PreviewBuilder::Picture& _picture;
};

/// The value that a share of them does not pass, so that a few extremes do not hide the rest.
float FindQuantile(std::vector<float> values, double share) {
    if (values.empty()) return 0.0f;
    auto const at =
        values.begin() + static_cast<ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

}  // namespace

PreviewBuilder::PreviewBuilder(Map const& map, int firstChannel, int width, int height)
    : _map(map),
      _firstChannel(firstChannel),
      _factor(std::max(1, (std::max(width, height) + kLongestSide - 1) / kLongestSide)),
      _width((width + _factor - 1) / _factor),
      _height((height + _factor - 1) / _factor),
      _sourceWidth(width),
      _sums(static_cast<size_t>(_width) * _height * map.GetNumChannels(), 0.0f),
      _weights(static_cast<size_t>(_width) * _height, 0.0f) {}

void PreviewBuilder::Add(int row, TexelRowView const& texels) {
    size_t const line = static_cast<size_t>(row / _factor) * _width;
    size_t const numTexels = _weights.size();
    for (int x = 0; x < _sourceWidth; ++x) {
        float const weight = texels.coverage[x];
        if (!(weight > 0.0f)) continue;
        size_t const to = line + x / _factor;
        _weights[to] += weight;
        for (int c = 0; c < _map.GetNumChannels(); ++c) {
            _sums[c * numTexels + to] +=
                weight * texels.values[static_cast<size_t>(_firstChannel + c) * texels.stride +
                                       static_cast<size_t>(x)];
        }
    }
}

PreviewBuilder::Picture PreviewBuilder::DrawFlow() const {
    size_t const numTexels = _weights.size();
    std::vector<float> flow(2 * numTexels, 0.0f);
    std::vector<uint8_t> isInside(numTexels, 0);
    for (size_t texel = 0; texel < numTexels; ++texel) {
        if (!(_weights[texel] > 0.0f)) continue;
        isInside[texel] = 1;
        // Texture coordinates to texels, v upwards.
        flow[2 * texel] = (_sums[texel] / _weights[texel] - _map.zero) * static_cast<float>(_width);
        flow[2 * texel + 1] =
            -(_sums[numTexels + texel] / _weights[texel] - _map.zero) * static_cast<float>(_height);
    }
    std::vector<uint8_t> const grey = ConvolveLines(_width, _height, flow, isInside);
    Picture picture;
    picture.width = _width;
    picture.height = _height;
    for (uint8_t value : grey) picture.pixels.insert(picture.pixels.end(), 3, value);
    return picture;
}

PreviewBuilder::Picture PreviewBuilder::Draw() const {
    if (_map.kind == MapKind::Field && _map.GetNumChannels() == 2) return DrawFlow();
    size_t const numTexels = _weights.size();
    int const numChannels = _map.GetNumChannels();
    // A vector map shows its three components as colours; anything else its first channel.
    bool const isColour = numChannels == 3;
    bool const isLine = _map.averaging == Averaging::Line;  // its sign is free: show magnitudes
    auto const value = [&](int c, size_t texel) {
        float const mean = _sums[c * numTexels + texel] / _weights[texel];
        return isLine ? std::abs(mean) : mean;
    };
    std::array<float, 3> low{}, high{};
    for (int c = 0; c < (isColour ? 3 : 1); ++c) {
        std::vector<float> values;
        for (size_t texel = 0; texel < numTexels; ++texel) {
            if (_weights[texel] > 0.0f)
                values.push_back(_map.isSigned && !isColour ? std::abs(value(c, texel))
                                                            : value(c, texel));
        }
        if (_map.isSigned && !isColour) {
            high[c] = FindQuantile(std::move(values), 0.98);
            low[c] = -high[c];
        } else {
            low[c] = FindQuantile(values, isColour ? 0.0 : 0.02);
            high[c] = FindQuantile(std::move(values), isColour ? 1.0 : 0.98);
        }
    }
    if (_map.averaging != Averaging::Plain) {
        low.fill(isLine ? 0.0f : -1.0f);
        high.fill(1.0f);
    }

    Picture picture;
    picture.width = std::max(_width, 128);
    picture.height = _height + kLegendHeight;
    picture.pixels.assign(static_cast<size_t>(picture.width) * picture.height * 3, 38);
    Canvas canvas(picture);
    auto const unit = [&](int c, float v) {
        return high[c] > low[c] ? (v - low[c]) / (high[c] - low[c]) : 0.5f;
    };
    for (size_t texel = 0; texel < numTexels; ++texel) {
        if (!(_weights[texel] > 0.0f)) continue;
        Colour colour;
        if (isColour) {
            for (int c = 0; c < 3; ++c) colour[static_cast<size_t>(c)] = unit(c, value(c, texel));
        } else {
            float const t = unit(0, value(0, texel));
            colour = _map.isSigned ? Diverging(2 * t - 1) : Sequential(t);
        }
        canvas.Set(static_cast<int>(texel) % _width, static_cast<int>(texel) / _width, colour);
    }
    // The legend: least value, ramp, largest value.
    float const least = *std::min_element(low.begin(), low.begin() + (isColour ? 3 : 1));
    float const most = *std::max_element(high.begin(), high.begin() + (isColour ? 3 : 1));
    std::string const left = fmt::format("{:.3g}", least), right = fmt::format("{:.3g}", most);
    int const textY = _height + 7, rampBegin = 8 + Canvas::TextWidth(left) + 4;
    int const rampEnd = picture.width - 8 - Canvas::TextWidth(right) - 8;
    canvas.Text(8, textY, left);
    canvas.Text(picture.width - 8 - Canvas::TextWidth(right), textY, right);
    for (int x = rampBegin; x < rampEnd; ++x) {
        float const t = static_cast<float>(x - rampBegin) /
                        static_cast<float>(std::max(1, rampEnd - rampBegin - 1));
        Colour const colour = isColour        ? Colour{t, t, t}
                              : _map.isSigned ? Diverging(2 * t - 1)
                                              : Sequential(t);
        for (int y = 0; y < 14; ++y) canvas.Set(x, textY + y, colour);
    }
    return picture;
}

void WritePng(std::string const& path, PreviewBuilder::Picture const& picture) {
    AtomicFile file(path);
    ImagesModule const& images = LoadImagesModule();
    std::array<char, 512> reason{};
    if (!images.writePng(file.GetTemporaryPath().c_str(), picture.width, picture.height,
                         picture.pixels.data(), reason.data(), reason.size())) {
        throw Error(ErrorCode::Io, fmt::format("'{}' cannot be written: {}", path, reason.data()));
    }
    file.Commit();
}

}  // namespace limn::engine
