// SPDX-License-Identifier: Apache-2.0
#include "engine/images/grey_image.h"

#include <fmt/format.h>

#include "engine/images/images_module.h"
#include "far_ext/error.h"

namespace limn::engine {

GreyImage ReadFirstChannel(std::string const& path) {
    GreyImage image;
    auto const allocate = [](void* user, int width, int height) {
        auto& to = *static_cast<GreyImage*>(user);
        to.width = width;
        to.height = height;
        to.values.resize(static_cast<size_t>(width) * static_cast<size_t>(height));
        return to.values.data();
    };
    char reason[512] = "";
    if (!LoadImagesModule().readFirstChannel(path.c_str(), allocate, &image, reason,
                                             sizeof reason)) {
        throw Error(ErrorCode::Io, fmt::format("{}: cannot be read as an image: {}", path, reason));
    }
    return image;
}

}  // namespace limn::engine
