// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/bake/bake.h"
#include "engine/bake/raster/textured_faces.h"
#include "eval/surface/limit_surface.h"

namespace limn::engine {

/// What every audit of a bake looks at; options, report and job are kept by reference.
struct AuditInput {
    AuditInput(Model const& bakedModel, BakeOptions const& bakeOptions,
               BakeReport const& bakeReport, Job const& auditJob);

    /// Of the texels' centres, or of all samples that the bake took in them.
    TileGrid MakeGrid(int tile) const;
    TileGrid MakeSampleGrid(int tile) const;

    Model model;
    Far::TopologyLevel level;
    BakeOptions const& options;
    BakeReport const& bake;
    Job const& job;
    eval::LimitSurface const& surface;
    TexturedFaces faces;
};

}  // namespace limn::engine
