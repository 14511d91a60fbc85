// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "engine/bake/maps/map_colours.h"
#include "engine/images/picture.h"
#include "engine/images/picture_view.h"
#include "engine/scene/scene.h"

namespace limn::engine {

/// Draws a mesh in the colours of a primvar of one channel, between its vertices, with a legend
/// below.
///
/// \param map     the primvar's name, its units, and whether it is signed
/// \param range   of the values that are seen; none: 1st to 99th percentile
/// \throws Error  BadOption: no such primvar, or a view without a direction
Picture DrawValues(Scene const& scene, MapTraits const& map, PictureView const& view,
                   std::optional<PreviewRange> const& range = {});

/// Draws a mesh flat shaded, each face by its own normal. \throws Error  as above
Picture DrawShaded(Scene const& scene, PictureView const& view);

/// Draws highlight lines, the reflections of parallel strip lights: where they kink, normals do;
/// where they turn sharply, curvature jumps. They measure nothing, so there is no legend.
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

/// Draws a mesh as DrawArrows does, with lines on it, each a list of points near its surface. What
/// lies behind it is hidden.
///
/// \throws Error  as above
Picture DrawLines(Scene const& scene, std::vector<std::vector<Eigen::Vector3d>> const& lines,
                  PictureView const& view);

}  // namespace limn::engine
