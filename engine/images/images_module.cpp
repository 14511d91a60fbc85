// SPDX-License-Identifier: Apache-2.0
#include "engine/images/images_module.h"

#include <filesystem>
#include <string>
#include <system_error>

#include <dlfcn.h>
#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::engine {

namespace {

ImagesModule const* OpenModule() {
    namespace fs = std::filesystem;
    std::error_code ignored;
    fs::path const program = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    std::string reason;
    for (fs::path const& folder :
         {program, program / "engine", program / ".." / "engine", program / ".." / ".." / "engine",
          program / ".." / LIMN_MODULE_FOLDER}) {
        fs::path const file = folder / "limn_images.so";
        if (!fs::exists(file, ignored)) continue;
        void* const handle = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (handle) {
            auto const entry = reinterpret_cast<decltype(&limn_images_module)>(
                ::dlsym(handle, "limn_images_module"));
            if (entry) return entry();
        }
        char const* const error = ::dlerror();
        reason = error ? error : "it has no entry point";
    }
    throw Error(ErrorCode::Io,
                fmt::format("the image module limn_images.so cannot be loaded: {}",
                            reason.empty() ? "it is not beside the program" : reason));
}

}  // namespace

ImagesModule const& LoadImagesModule() {
    static ImagesModule const* const module = OpenModule();
    return *module;
}

}  // namespace limn::engine
