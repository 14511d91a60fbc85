// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/sample_averages.h"

#include <algorithm>
#include <cmath>

#include "engine/bake/mip_chain.h"

namespace limn::engine {

namespace {

/// Divides sums by their number, or unit vectors' by their length.
void Average(Averaging averaging, int numHits, std::span<float* const> values) {
    float divisor = static_cast<float>(numHits);
    if (averaging == Averaging::UnitVector) {
        float squares = 0.0f;
        for (float const* value : values) squares += *value * *value;
        if (squares > 0.0f) divisor = std::sqrt(squares);
    }
    for (float* value : values) *value /= divisor;
}

}  // namespace

void SampleAverages::Start(Strip& strip) {
    _numHits.assign(strip.GetNumTexels(), 0);
    std::fill(strip.planes.begin(), strip.planes.end(), 0.0f);
    std::fill(strip.texels.owner.begin(), strip.texels.owner.end(), -1);
    std::fill(strip.texels.overlap.begin(), strip.texels.overlap.end(), uint8_t{0});
    std::fill(strip.texels.failed.begin(), strip.texels.failed.end(), uint8_t{0});
    auto const numLines = std::count_if(_groups.begin(), _groups.end(), [](auto const& group) {
        return group.averaging == Averaging::Line;
    });
    _lineSums.assign(static_cast<size_t>(numLines) * 6 * strip.GetNumTexels(), 0.0f);
}

void SampleAverages::Add(TexelStrip const& texels, std::vector<float> const& planes, Strip& strip) {
    size_t const numTexels = strip.GetNumTexels();
    float* lineSum = _lineSums.data();
    for (ChannelGroup const& group : _groups) {
        if (group.averaging == Averaging::Count) continue;  // of the texel's centre alone
        size_t const first = static_cast<size_t>(group.first) * numTexels;
        if (group.averaging != Averaging::Line) {
            size_t const end = first + static_cast<size_t>(group.count) * numTexels;
            for (size_t k = first; k < end; ++k) strip.planes[k] += planes[k];
            continue;
        }
        for (size_t a = 0; a < 3; ++a) {
            for (size_t b = a; b < 3; ++b, lineSum += numTexels) {
                float const* const da = &planes[first + a * numTexels];
                float const* const db = &planes[first + b * numTexels];
                for (size_t k = 0; k < numTexels; ++k) lineSum[k] += da[k] * db[k];
            }
        }
    }
    for (size_t k = 0; k < numTexels; ++k) {
        _numHits[k] += texels.owner[k] >= 0;
        strip.texels.overlap[k] |= texels.overlap[k];
        strip.texels.failed[k] |= texels.failed[k];
    }
}

void SampleAverages::Finish(int numSamples, Strip& strip) const {
    size_t const numTexels = strip.GetNumTexels();
    strip.coverage.resize(numTexels);
    std::vector<float*> values;
    for (size_t k = 0; k < numTexels; ++k) {
        strip.isCovered[k] = _numHits[k] > 0;
        strip.coverage[k] = static_cast<float>(_numHits[k]) / static_cast<float>(numSamples);
        if (_numHits[k] == 0) continue;
        size_t lineSum = k;  // of the next entry
        for (ChannelGroup const& group : _groups) {
            if (group.averaging == Averaging::Count) continue;
            values.clear();
            for (int c = 0; c < group.count; ++c) {
                values.push_back(strip.GetPlane(group.first + c) + k);
            }
            if (group.averaging != Averaging::Line) {
                Average(group.averaging, _numHits[k], values);
                continue;
            }
            std::array<double, 6> sum;
            for (double& entry : sum) {
                entry = _lineSums[lineSum];
                lineSum += numTexels;
            }
            auto const line = FindMainLine(sum);
            for (size_t c = 0; c < 3; ++c) *values[c] = line[c];
        }
    }
}

}  // namespace limn::engine
