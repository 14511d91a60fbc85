// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/bake/bake_options.h"
#include "engine/bake/bake_report.h"
#include "engine/bake/memory_sink.h"
#include "engine/scene/job.h"

namespace limn::engine {

/// Bakes maps of a mesh's limit surface to UDIM tiles, in EXR files named by options.pattern [Bake
/// 1]. Files appear one by one as they are complete; on an error or a stop those already complete
/// stay.
///
/// Memory   a few strips of 64 rows per thread, whatever the size of the image.
/// Threads  TBB's current arena; results do not depend on it.
///
/// \throws Error  BadMesh: no UVs, or nothing to bake. BadOption. Io
/// \throws Stopped
BakeReport Bake(Model const& model, BakeOptions const& options, Job& job);

/// A bake in memory.
struct BakedImages {
    std::vector<BakedImage> images;  ///< by tile, then as the report's files; those with texels
    BakeReport report;
};

/// The same texels, by the same road, kept in memory. A pattern with {map} and <UDIM> is taken
/// where the options have none.
///
/// \throws Error  as Bake
BakedImages BakeToMemory(Model const& model, BakeOptions const& options, Job& job);

}  // namespace limn::engine
