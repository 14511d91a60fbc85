// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/images/picture.h"
#include "engine/scene/scene.h"

namespace limn::engine {

/// How to look at a mesh: from far away along a direction, with z (or y, looking along z) upwards.
struct PictureView {
    std::array<double, 3> from{1.0, 0.6, 0.8};  ///< the side that is seen
    int size = 800;                             ///< pixels, width and height
};

/// Draws a mesh in the colours of a signed value per vertex (a primvar of one channel), with its
/// range below.
///
/// \throws Error  BadOption: no such primvar, or a view without a direction
Picture DrawValues(Scene const& scene, std::string const& primvar, PictureView const& view);

/// Draws a mesh flat shaded, each face by its own normal. \throws Error  as above
Picture DrawShaded(Scene const& scene, PictureView const& view);

/// Draws highlight lines, the reflections of parallel strip lights: where they kink, normals do;
/// where they turn sharply, curvature jumps.
///
/// \throws Error  as above
/// Source  [Zhu11] Sec. 4.3 and Fig. 13
Picture DrawHighlights(Scene const& scene, PictureView const& view);

/// Draws a mesh, brighter where it faces the eye, with arrows of one length on it, spread evenly
/// over the picture, along tangent vectors. No arrow stands where the vector is below 1e-6 of the
/// longest.
///
/// \param vectors  per vertex
/// \throws Error   as above
Picture DrawArrows(Scene const& scene, std::vector<std::array<double, 3>> const& vectors,
                   PictureView const& view);

}  // namespace limn::engine
