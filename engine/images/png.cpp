// SPDX-License-Identifier: Apache-2.0
#include "engine/images/png.h"

#include <array>

#include <fmt/format.h>

#include "engine/images/images_module.h"
#include "engine/io/file.h"
#include "far_ext/error.h"

namespace limn::engine {

void WritePng(std::string const& path, Picture const& picture) {
    AtomicFile file(path);
    ImagesModule const& images = LoadImagesModule();
    std::array<char, 512> reason{};
    if (!images.writePng(file.GetTemporaryPath().c_str(), picture.GetWidth(), picture.GetHeight(),
                         picture.GetPixels(), reason.data(), reason.size())) {
        throw Error(ErrorCode::Io, fmt::format("'{}' cannot be written: {}", path, reason.data()));
    }
    file.Commit();
}

}  // namespace limn::engine
