// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "engine/images/picture_view.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"

namespace limn::engine {

/// What is seen of a limit surface at one sample of a picture.
struct SeenPlace {
    double height = -std::numeric_limits<double>::infinity();  ///< towards the eye
    float shade = 0.0f;                                        ///< PictureCamera::Shade
    float u = 0.0f, v = 0.0f;  ///< texture coordinates, where it has a tile
    int tile = 0;              ///< UDIM number; 0 where no map can be

    bool IsSurface() const { return height > -std::numeric_limits<double>::infinity(); }
};

/// Looks at the limit surface of a mesh, and at the limit of its texture coordinates on it.
///
/// Accuracy  between places of the limit some three samples apart it is flat
///
/// \param size    samples, width and height
/// \param groups  whose faces have texture coordinates to be seen; empty for all
/// \return        [row from the top][column]
/// \throws Error  BadMesh, BadOption as a bake does
/// \throws Stopped
std::vector<SeenPlace> LookAtSurface(Model const& model, std::vector<std::string> const& groups,
                                     Orientation orientation, PictureView const& view, int size,
                                     Job const& job);

}  // namespace limn::engine
