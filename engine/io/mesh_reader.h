// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "engine/scene/scene.h"

namespace limn::engine {

/// Reads an OBJ, PLY or OFF file by its ending (or, failing that, its first bytes).
///
/// \throws Error  Io if the file cannot be read; BadMesh, as "FILE:LINE: ...", if its content is
///                wrong
Scene ReadMesh(std::string const& path);

}  // namespace limn::engine
