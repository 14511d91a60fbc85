// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/bake/raster/uv_raster.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"

namespace limn::engine {

/// The faces of a mesh in texture space: their limit there, which of them a bake takes, and where
/// they lie. Immutable; for many threads.
struct TexturedFaces {
    /// \param model   kept by reference
    /// \param groups  whose faces to take; empty for all
    /// \throws Error  BadMesh: no texture coordinates, or such that no texel can be told from
    /// another
    ///                there. BadOption: a group that there is not
    TexturedFaces(Model const& model, std::vector<std::string> const& groups, Job const& job);

    eval::LimitSurface const& surface;  ///< of the texture coordinates
    std::span<double const> uvs;        ///< 2 per value
    std::vector<char> isBaked;          ///< per face: of the groups, with a limit and with UVs
    std::vector<UVBounds> bounds;       ///< per face; meaningless unless it is baked
};

}  // namespace limn::engine
