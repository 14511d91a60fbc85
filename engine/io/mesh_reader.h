// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "engine/scene/scene.h"

namespace limn::engine {

/// Reads an OBJ, PLY or OFF file by its ending (or, failing that, its first bytes).
///
/// \throws Error  Io if the file cannot be read; BadMesh, as "FILE:LINE: ...", if its content is
///                wrong
Scene ReadMesh(std::string const& path);

/// The same for a file's bytes.
///
/// \param path    what messages call it, and what its ending is taken from
/// \throws Error  BadMesh
Scene ParseMesh(std::string const& path, std::string_view bytes);

}  // namespace limn::engine
