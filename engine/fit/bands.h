// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "engine/scene/scene.h"
#include "eval/fit/decompose.h"

namespace limn::engine {

/// Volume and bounding box of a mesh's polygons.
struct MeshExtent {
    std::optional<double> volume;  ///< none where the mesh is open or not manifold
    std::array<double, 3> low{}, high{};
};

MeshExtent MeasureExtent(Scene const& scene, Far::TopologyLevel const& level);

/// The bands of a scene's positions, lowest frequencies first, then the remainder: they add up to
/// the positions.
///
/// \throws Error  BadMesh: a coordinate that is no number
std::vector<std::vector<double>> SplitIntoBands(Scene const& scene, eval::LimitOperator const& A,
                                                int count);

/// Frames Q_1 to Q_steps on the way from `from` to `to`.
///
/// \param visit   receives each frame's positions
/// \throws Error  BadMesh where the meshes do not have the same faces (the first difference is
///                named), or a coordinate is no number
using VisitFrame = std::function<void(int step, std::vector<double> const& positions)>;
void Morph(Scene const& from, Scene const& to, eval::LimitOperator const& A, int detail,
           double rate, int steps, VisitFrame const& visit);

}  // namespace limn::engine
