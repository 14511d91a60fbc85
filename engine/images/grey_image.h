// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace limn::engine {

/// One channel of an image, rows from the top.
struct GreyImage {
    int width = 0, height = 0;
    std::vector<float> values;
};

/// The first channel of an image; 8 and 16 bits per value become 0 to 1, floats stay as they are.
///
/// \throws Error  Io: a file that cannot be read, or is no image
GreyImage ReadFirstChannel(std::string const& path);

}  // namespace limn::engine
