// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "engine/scene/scene.h"

namespace limn::engine {

/// True for bytes that begin as a PLY file does.
bool IsPly(std::string_view bytes);

/// Reads PLY, ASCII or binary of either byte order, with elements in any order: vertex positions,
/// and faces or triangle strips (`tristrips`, parted by -1). Texture coordinates are per vertex
/// (s,t; u,v; texture_u,texture_v) or per face corner (a list `texcoord`). A face's `texnumber`
/// puts it into the material named by the header's "comment TextureFile NAME". Vertex colours
/// become the primvar "color", other scalar vertex properties primvars of their own name; normals
/// are skipped.
///
/// \throws Error  BadMesh, as "FILE:LINE: ..." in text and "FILE: vertex 7: ..." in binary files
void ReadPly(std::string_view bytes, Scene& scene);

}  // namespace limn::engine
