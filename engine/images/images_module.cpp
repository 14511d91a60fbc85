// SPDX-License-Identifier: Apache-2.0
#include "engine/images/images_module.h"

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include <dlfcn.h>
#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::engine {

namespace {

namespace fs = std::filesystem;

constexpr char const* kFile = "limn_images.so";

/// Where the module lies for limn itself, and for programs of its build tree.
std::vector<fs::path> ListFolders() {
    std::error_code ignored;
    fs::path const program = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    return {program, program / "engine", program / ".." / "engine",
            program / ".." / ".." / "engine", program / ".." / LIMN_MODULE_FOLDER};
}

/// \param reason  receives why not, where the result is null
ImagesModule const* Open(std::string const& file, std::string& reason) {
    if (void* const handle = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
        auto const entry =
            reinterpret_cast<decltype(&limn_images_module)>(::dlsym(handle, "limn_images_module"));
        if (entry) return entry();
    }
    char const* const error = ::dlerror();
    reason = error ? error : "it has no entry point";
    return nullptr;
}

ImagesModule const* OpenModule() {
    std::string reason;
    for (fs::path const& folder : ListFolders()) {
        std::error_code ignored;
        if (!fs::exists(folder / kFile, ignored)) continue;
        if (auto const* const module = Open(folder / kFile, reason)) return module;
    }
    // Other programs that link limn::engine have its folder in their run path.
    if (reason.empty()) {
        if (auto const* const module = Open(kFile, reason)) return module;
    }
    throw Error(ErrorCode::Io,
                fmt::format("the image module limn_images.so cannot be loaded: {}", reason));
}

}  // namespace

ImagesModule const& LoadImagesModule() {
    static ImagesModule const* const module = OpenModule();
    return *module;
}

}  // namespace limn::engine
