// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "engine/smooth/smooth.h"

namespace limn::engine {

/// Vertices that a grid to measure critical widths on has, unless the mesh itself has more.
inline constexpr double kMaxCriticalVertices = 10000.0;

/// What factor on the widths, up to 1, the closed components carry [Cascade 7].
///
/// \param widths  of one step
double MeasureCriticalFactor(Model const& model, ScaledWidths const& widths,
                             SmoothOptions const& options, Job& job);

/// The largest constant width that all closed components carry, to 0.5 %; none without any that has
/// an area.
///
/// \param model   as Smooth
/// \throws Error  BadMesh as Smooth
/// \throws Stopped
std::optional<double> MeasureCriticalWidth(Model const& model, Job& job);

}  // namespace limn::engine
