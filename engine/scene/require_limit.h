// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/scene/model.h"

namespace limn::engine {

/// Refuses a mesh whose limit surface would take too much, before there is work.
///
/// \throws Error  TooLarge: what eval::LimitSurface::FindExcess finds, with the mesh's path and the
///                face's line
void RequireLimit(Model const& model);

}  // namespace limn::engine
