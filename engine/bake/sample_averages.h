// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/bake/maps/channel_group.h"
#include "engine/bake/strip.h"

namespace limn::engine {

/// Averages N x N samples per texel over those that are covered: values plainly, unit vectors to
/// unit vectors, lines as d d^T; counts are left alone. One per thread; its memory is used again.
class SampleAverages {
public:
    /// \param groups  of all planes, in their order
    explicit SampleAverages(std::vector<ChannelGroup> groups) : _groups(std::move(groups)) {}

    /// Clears the strip's planes.
    void Start(Strip& strip);

    /// Adds one sample per texel. \param planes  as the strip's; 0 where nothing is covered
    void Add(TexelStrip const& texels, std::vector<float> const& planes, Strip& strip);

    /// Turns sums into means, and says how much of each texel is covered.
    void Finish(int numSamples, Strip& strip) const;

private:
    std::vector<ChannelGroup> _groups;
    std::vector<int> _numHits;     // per texel
    std::vector<float> _lineSums;  // per line: d d^T, six planes
};

}  // namespace limn::engine
