// SPDX-License-Identifier: Apache-2.0
#include "engine/images/grey_image.h"

#include <utility>

#include "engine/images/channel_image.h"

namespace limn::engine {

GreyImage ReadFirstChannel(std::string const& path) {
    ChannelImage image = ReadChannels(path, {}, 1);
    return {image.width, image.height, std::move(image.values)};
}

}  // namespace limn::engine
