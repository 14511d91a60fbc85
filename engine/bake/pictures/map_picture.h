// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/bake/bake.h"
#include "engine/images/picture_view.h"

namespace limn::engine {

// Pictures of a finished bake: the limit surface, shaded, with a map on it in the colours that its
// preview would have. Colours come from the files, as a renderer would look them up: bilinearly, of
// counts and lines the closest texel. Faces whose texels are in none of them are grey.
//
// There is one picture of each map, of all tiles of the mesh: NAME.picture.png, or
// NAME.MAP.picture.png where maps share a file, NAME being the file's without the tile.

/// Draws the maps of a bake, into files that appear together when all are complete.
///
/// The colours' range is options.previewRange, of the values that are seen.
///
/// \param report  of the bake by these options
/// \return        the files' paths
/// \throws Error  BadOption: a flow in texture coordinates has no colours. Io
/// \throws Stopped
std::vector<std::string> WriteMapPictures(Model const& model, BakeOptions const& options,
                                          BakeReport const& report, PictureView const& view,
                                          Job& job);

/// Removes the pictures that an earlier bake of the same names has left, where this one has written
/// files anew.
void RemoveMapPictures(Model const& model, BakeOptions const& options, BakeReport const& report);

}  // namespace limn::engine
