// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "engine/bake/bake.h"
#include "engine/bake/uv_raster.h"
#include "eval/surface/limit_surface.h"

namespace limn::engine {

/// What every audit of a bake looks at; all but the surfaces is kept by reference.
struct AuditInput {
    AuditInput(Scene const& bakedScene, Far::TopologyRefiner const& refiner,
               BakeOptions const& bakeOptions, BakeReport const& bakeReport);

    TileGrid MakeGrid(int tile) const;

    Scene const& scene;
    Far::TopologyLevel level;
    BakeOptions const& options;
    BakeReport const& bake;
    eval::LimitSurface surface, uvSurface;
    std::vector<char> isBaked;  ///< per face: selected, and with a limit
};

}  // namespace limn::engine
