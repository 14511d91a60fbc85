// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "far_ext/error.h"

namespace limn::engine {

/// Refuses a scene whose parts do not belong together.
///
/// \throws Error  what far_ext::Validate refuses; BadMesh: values, UVs, primvars or groups of
/// another
///                count than vertices, corners or faces ask for, or positions or UVs that are not
///                finite
void CheckScene(Scene const& scene);

/// The part of it that looks at positions. \throws Error BadMesh
void CheckPositions(far_ext::ControlMesh const& cage, std::vector<double> const& positions);

/// Runs `check`, and lets what it refuses begin with the mesh's path.
template <class Check>
auto NamingMesh(std::string const& path, Check check) {
    try {
        return check();
    } catch (Error const& error) {
        throw Error(error.GetCode(), path + ": " + error.what());
    }
}

}  // namespace limn::engine
