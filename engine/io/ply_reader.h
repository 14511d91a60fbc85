// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "engine/scene/scene.h"

namespace limn::engine {

/// Reads PLY, ASCII or binary of either byte order: vertex positions and faces; texture coordinates
/// per vertex (s,t; u,v; texture_u,texture_v) or per face corner (a list `texcoord`). Vertex
/// colours become the primvar "color", other scalar vertex properties primvars of their own name;
/// normals are skipped.
///
/// \throws Error  BadMesh, as "FILE:LINE: ..." in text and "FILE: vertex 7: ..." in binary files
void ReadPly(std::string_view bytes, Scene& scene);

}  // namespace limn::engine
