#pragma once

#include <string>

#include "engine/scene.h"

namespace limn::engine {

/// Writes a mesh as OBJ (with UVs, groups and tags) or PLY (with corner UVs and primvars, without
/// tags or groups) by its ending in small or capital letters, complete or not at all. Numbers read back as the same float, or the
/// same double with `isDouble`.
///
/// \param warnings  receives what the format cannot hold; may be null
/// \throws Error    BadOption: another ending. Io
void WriteMesh(std::string const& path, Scene const& scene, bool isDouble, std::vector<std::string>* warnings);

}  // namespace limn::engine
