// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "engine/scene/scene.h"

namespace limn::engine {

/// Reads OFF (ASCII): "OFF", counts, positions, faces. Colours after a face's corners are skipped,
/// COFF's vertex colours become the primvar "color".
///
/// \throws Error  BadMesh, as "FILE:LINE: ..."
void ReadOff(std::string_view text, Scene& scene);

}  // namespace limn::engine
