// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace limn::engine {

/// Some channels of an image, texel by texel, rows from the top.
struct ChannelImage {
    int width = 0, height = 0, numChannels = 0;
    std::vector<float> values;

    float Get(int x, int y, int channel) const {
        return values[(static_cast<size_t>(y) * width + x) * numChannels + channel];
    }
};

/// Reads channels that lie side by side; 8 and 16 bits per value become 0 to 1, floats stay as they
/// are.
///
/// \param firstNames  what the first of them may be called; empty: the image's first
/// \throws Error      Io: a file that cannot be read, or is no image, or has not as many
ChannelImage ReadChannels(std::string const& path, std::vector<char const*> const& firstNames,
                          int numChannels);

}  // namespace limn::engine
