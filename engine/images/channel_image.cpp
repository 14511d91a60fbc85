// SPDX-License-Identifier: Apache-2.0
#include "engine/images/channel_image.h"

#include <fmt/format.h>

#include "engine/images/images_module.h"
#include "far_ext/error.h"

namespace limn::engine {

ChannelImage ReadChannels(std::string const& path, std::vector<char const*> const& firstNames,
                          int numChannels) {
    ChannelImage image;
    image.numChannels = numChannels;
    auto const allocate = [](void* user, int width, int height) {
        auto& to = *static_cast<ChannelImage*>(user);
        to.width = width;
        to.height = height;
        to.values.resize(static_cast<size_t>(width) * static_cast<size_t>(height) * to.numChannels);
        return to.values.data();
    };
    char reason[512] = "";
    if (!LoadImagesModule().readChannels(path.c_str(), firstNames.data(), firstNames.size(),
                                         numChannels, allocate, &image, reason, sizeof reason)) {
        throw Error(ErrorCode::Io, fmt::format("{}: cannot be read as an image: {}", path, reason));
    }
    return image;
}

}  // namespace limn::engine
