// SPDX-License-Identifier: Apache-2.0
#include "engine/images/line_convolution.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

namespace limn::engine {

namespace {

constexpr int kSteps = 24;         // each way
constexpr float kStep = 0.75f;     // pixels
constexpr float kContrast = 2.4f;  // a mean of so many values is grey; this spreads it out again

/// A number from 0 to 1 per pixel, without pattern.
float Hash(uint32_t x, uint32_t y) {
    uint32_t h = x * 0x9e3779b1u ^ (y + 0x7f4a7c15u) * 0x85ebca77u;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return static_cast<float>((h ^ (h >> 15)) >> 8) * 0x1p-24f;
}

class LineConvolution {
public:
    LineConvolution(int width, int height, std::span<float const> flow,
                    std::span<uint8_t const> isInside)
        : _width(width), _height(height), _flow(flow), _isInside(isInside) {}

    uint8_t At(int x, int y) const {
        if (!IsInside(x, y)) return 0;
        float sum = Hash(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
        int count = 1;
        for (float way : {1.0f, -1.0f})
            Follow(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, way, sum, count);
        float const mean = sum / static_cast<float>(count);
        float const grey = 0.5f + kContrast * (mean - 0.5f);
        return static_cast<uint8_t>(std::lround(std::clamp(grey, 0.02f, 1.0f) * 255.0f));
    }

private:
    bool IsInside(int x, int y) const {
        return x >= 0 && y >= 0 && x < _width && y < _height &&
               _isInside[static_cast<size_t>(y) * static_cast<size_t>(_width) +
                         static_cast<size_t>(x)];
    }

    void Follow(float x, float y, float way, float& sum, int& count) const {
        for (int step = 0; step < kSteps; ++step) {
            size_t const pixel =
                static_cast<size_t>(y) * static_cast<size_t>(_width) + static_cast<size_t>(x);
            float const dx = _flow[2 * pixel], dy = _flow[2 * pixel + 1];
            float const length = std::sqrt(dx * dx + dy * dy);
            if (!(length > 0.0f)) return;
            x += way * kStep * dx / length;
            y += way * kStep * dy / length;
            if (!(x >= 0.0f && y >= 0.0f) || !IsInside(static_cast<int>(x), static_cast<int>(y)))
                return;
            sum += Hash(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
            ++count;
        }
    }

    int _width, _height;
    std::span<float const> _flow;
    std::span<uint8_t const> _isInside;
};

}  // namespace

std::vector<uint8_t> ConvolveLines(int width, int height, std::span<float const> flow,
                                   std::span<uint8_t const> isInside) {
    LineConvolution const convolution(width, height, flow, isInside);
    std::vector<uint8_t> grey(static_cast<size_t>(width) * static_cast<size_t>(height));
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x)
            grey[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)] =
                convolution.At(x, y);
    });
    return grey;
}

}  // namespace limn::engine
