// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/bake/bake_options.h"
#include "engine/bake/bake_report.h"
#include "engine/bake/memory_sink.h"
#include "engine/scene/job.h"

namespace limn::engine {

inline constexpr int kMaxImageSide = 65536;  ///< texels

/// Bakes maps of a mesh's limit surface to UDIM tiles, in EXR files named by options.pattern [Bake
/// 1]. Files appear one by one as they are complete; on an error or a stop those already complete
/// stay.
///
/// Memory   a few strips of 64 rows per thread, whatever the size of the image.
/// Threads  TBB's current arena; results do not depend on it.
///
/// \throws Error  BadMesh: no UVs, or nothing to bake. BadOption: among others, a side below 1 or
///                above kMaxImageSide. Io
/// \throws Stopped
BakeReport Bake(Model const& model, BakeOptions const& options, Job& job);

/// The same texels, by the same road, to where the caller wants them, as they are finished. A
/// pattern with {map} and <UDIM> is taken where the options have none; what it names is up to the
/// destination.
///
/// \throws Error  as Bake; and what the destination throws
BakeReport BakeTo(BakeDestination& destination, Model const& model, BakeOptions const& options,
                  Job& job);

/// A bake in memory.
struct BakedImages {
    std::vector<BakedImage> images;  ///< by tile, then as the report's files; those with texels
    BakeReport report;
};

/// The same texels, kept in memory. The pattern as in BakeTo.
///
/// \throws Error  as Bake
BakedImages BakeToMemory(Model const& model, BakeOptions const& options, Job& job);

}  // namespace limn::engine
