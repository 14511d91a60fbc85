// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace limn::engine {

/// What limn uses OpenImageIO for. It takes 0.2 s to load, so it sits in a module of its own
/// (limn_images.so) that is loaded when a run first asks for it.
struct ImagesModule {
    /// Makes a PNG file of 8-bit RGB, row by row from the top: fillRow(user, row, rgb), and hands
    /// out its bytes: take(user, bytes, size), until one of them returns false. `texts` are pairs
    /// of keyword and text. On failure returns false and puts the reason into `reason`.
    bool (*encodePng)(int width, int height,
                      bool (*fillRow)(void* user, int row, unsigned char* rgb),
                      bool (*take)(void* user, void const* bytes, size_t size), void* user,
                      char const* const* texts, size_t numTexts, char* reason, size_t reasonSize);

    /// Reads channels of an image of any format, texel by texel, rows from the top: `numChannels`
    /// from the first on that has one of the names, or from the image's first without names.
    /// `allocate(user, width, height)` makes room for them. On failure as above.
    bool (*readChannels)(char const* path, char const* const* firstNames, size_t numNames,
                         int numChannels, float* (*allocate)(void* user, int width, int height),
                         void* user, char* reason, size_t reasonSize);
};

/// \throws Error  Io if the module is missing: beside the program, in its library folder, and in
/// the
///                run path that programs get from linking limn::engine
ImagesModule const& LoadImagesModule();

}  // namespace limn::engine

/// The module's one symbol.
extern "C" limn::engine::ImagesModule const* limn_images_module();
