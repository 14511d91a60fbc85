// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "far_ext/error.h"

namespace limn::engine {

/// Refuses a scene whose parts do not belong together. Primvars may hold any number, or none.
///
/// \throws Error  what far_ext::Validate refuses; BadMesh: arrays of another length than vertices,
///                corners or faces ask for, or positions, normals or UVs that are not finite
void CheckScene(Scene const& scene);

/// Numbers beyond this would pass the range of float somewhere between a mesh and its maps.
inline constexpr double kLargestNumber = 1e30;

/// Refuses positions, UVs and primvars that are beyond it or no numbers, as readers do.
///
/// \throws Error  BadMesh
void CheckMagnitudes(Scene const& scene);

/// The same of positions alone. \throws Error BadMesh
void CheckMagnitudes(std::span<double const> positions);

/// The part of it that looks at positions. \throws Error BadMesh
void CheckPositions(far_ext::ControlMesh const& cage, std::vector<double> const& positions);

/// What messages call a mesh that has neither path nor name.
inline std::string const kNameless = "mesh";

/// Runs `check`, and lets what it refuses begin with the mesh's path.
template <class Check>
auto NamingMesh(std::string const& path, Check check) {
    try {
        return check();
    } catch (Error const& error) {
        throw Error(error.GetCode(), (path.empty() ? kNameless : path) + ": " + error.what());
    }
}

}  // namespace limn::engine
