// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limn::engine {

/// How texels are averaged (supersampling, mip levels): plainly, or as what they are.
enum class Averaging {
    Plain,
    UnitVector,
    Line,
    Count  ///< not at all: a texel's own, of several the largest; padding has none
};

/// A run of channels that are averaged together.
struct ChannelGroup {
    int first = 0, count = 1;
    Averaging averaging = Averaging::Plain;
};

}  // namespace limn::engine
