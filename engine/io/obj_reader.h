// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "engine/scene/scene.h"

namespace limn::engine {

/// Reads Wavefront OBJ with OpenSubdiv's `t` tag lines (spec: crease, corner, hole,
/// interpolateboundary, facevaryinginterpolateboundary, creasemethod, smoothtriangles; vertexedit,
/// edgeedit and faceedit are named in a warning). Face indices are 1-based or negative, tag indices
/// 0-based. `v`, `vt`, `f`, `usemtl`, `g`, `o` and `t` are read; free-form geometry and words that
/// OBJ does not have are named in a warning, other statements skipped. A backslash at the end of a
/// line joins it with the next. Colours behind positions (`v x y z r g b`) become the primvar
/// "color".
///
/// A polygon of any size is kept. A file that ends within a line and leaves vertices unused is
/// taken for cut short and refused.
///
/// \param text   the file's bytes
/// \param scene  path is used in messages; cage, positions, uvs, groups, primvars and faceLines are
///               filled
/// \throws Error BadMesh, as "FILE:LINE: what is wrong; what would be right"
void ReadObj(std::string_view text, Scene& scene);

}  // namespace limn::engine
