// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/scene/model.h"
#include "engine/scene/scene_checks.h"
#include "eval/surface/limit_surface.h"

namespace limn::engine {

/// Refuses a mesh whose limit surface would take too much, before there is work.
///
/// \throws Error  TooLarge, as eval::LimitSurface::CheckSize; the message begins with the path
inline void RequireLimit(Model const& model) {
    NamingMesh(model.GetPath(), [&] { eval::LimitSurface::CheckSize(model.GetRefiner()); });
}

}  // namespace limn::engine
