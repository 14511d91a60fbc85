// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "engine/scene/scene.h"

namespace limn::engine {

/// True for bytes that begin with the keyword of an OFF file, of any kind.
bool IsOff(std::string_view bytes);

/// Reads OFF (ASCII): the keyword, counts (behind it, too), positions, faces. What the keyword's
/// letters name follows each position: normals (N), which are skipped, colours (C; 3 or 4 numbers),
/// which become the primvar "color", and texture coordinates (ST). Colours after a face's corners
/// are skipped.
///
/// \throws Error  BadMesh, as "FILE:LINE: ..."; 4OFF, nOFF and binary OFF are named
void ReadOff(std::string_view text, Scene& scene);

}  // namespace limn::engine
