// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/bake/bake_options.h"
#include "engine/bake/raster/textured_faces.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"

namespace limn::engine {

/// The tiles to bake, in order: those that faces reach into, of those asked for. One may turn out
/// to have no texel. Warns of faces that leave UDIM's range.
///
/// \param hasTileToken  whether outputs are named by their tile. If not, one tile is baked, and it
///                      must be the only one there is, or the only one asked for
/// \throws Error  BadOption: more tiles than anybody bakes unasked; faces in other tiles without a
///                token to name these by.  BadMesh: none of those asked for is there, and the bake
///                may not be empty
std::vector<int> FindBakedTiles(TexturedFaces const& faces, Model const& model,
                                BakeOptions const& options, bool hasTileToken, Job& job);

}  // namespace limn::engine
