// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/io/atomic_file.h"
#include "engine/scene/scene.h"

namespace limn::engine {

/// \throws Error  BadOption unless the path ends with .obj or .ply
void RequireMeshEnding(std::string const& path);

/// The bytes of a mesh file, and what its format cannot hold, one line each.
struct MeshBytes {
    std::string bytes;
    std::vector<std::string> leftOut;
};

/// A mesh as OBJ (with the primvar "color", UVs, normals, groups and tags) or PLY (with corner UVs
/// and primvars, without tags or groups) by its path's ending in small or capital letters. Numbers
/// read back as the same float or double.
///
/// \throws Error    BadOption: another ending.  BadMesh: a scene whose parts do not belong
/// together,
///                  as Model::Build refuses it; a coordinate that is no number or beyond the range
///                  of the precision
MeshBytes FormatMesh(std::string const& path, Scene const& scene, Precision precision);

/// Writes a mesh, complete or not at all.
///
/// \return what the format cannot hold
/// \throws Error    as FormatMesh; Io
std::vector<std::string> WriteMesh(std::string const& path, Scene const& scene,
                                   Precision precision);

/// Several meshes, and files beside them, that appear together or not at all.
class MeshSequence {
public:
    /// Writes a mesh under a temporary name. As WriteMesh
    std::vector<std::string> Add(std::string const& path, Scene const& scene, Precision precision);

    /// Writes another file under a temporary name. \throws Error Io
    void Add(std::string const& path, std::string const& bytes);

    /// Opens a file that someone else writes before Commit. \throws Error Io
    AtomicFile& Open(std::string const& path);

    /// Gives all of them their names. \throws Error Io; then none is left
    void Commit() { CommitTogether(_files); }

private:
    std::vector<std::unique_ptr<AtomicFile>> _files;
};

}  // namespace limn::engine
