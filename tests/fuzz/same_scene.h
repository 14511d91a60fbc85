// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/scene/scene.h"

namespace limn::fuzz {

/// What a format keeps of a scene.
struct Kept {
    bool tags = true, groups = true, allPrimvars = true;
};
inline constexpr Kept kKeptByObj{.allPrimvars = false};
inline constexpr Kept kKeptByPly{.tags = false, .groups = false};

/// Requires that two scenes have the same of all that was kept, to the bit. Numbers of texture
/// coordinates and groups may differ, what they stand for may not.
void RequireSame(engine::Scene const& a, engine::Scene const& b, Kept const& kept);

/// Requires that the scene, written as OBJ and as PLY, reads back as the same.
///
/// \pre it could be built
void RequireRoundTrips(engine::Scene const& scene);

}  // namespace limn::fuzz
