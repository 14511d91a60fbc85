// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/io/file.h"
#include "engine/scene/scene.h"

namespace limn::engine {

/// \throws Error  BadOption unless the path ends with .obj or .ply
void RequireMeshEnding(std::string const& path);

/// Writes a mesh as OBJ (with UVs, normals, groups and tags) or PLY (with corner UVs and primvars,
/// without tags or groups) by its ending in small or capital letters, complete or not at all.
/// Numbers read back as the same float, or the same double with `isDouble`.
///
/// \param warnings  receives what the format cannot hold; may be null
/// \throws Error    BadOption: another ending. Io
void WriteMesh(std::string const& path, Scene const& scene, bool isDouble,
               std::vector<std::string>* warnings);

/// The bytes WriteMesh would write. \throws Error as WriteMesh, but for Io
std::string FormatMesh(std::string const& path, Scene const& scene, bool isDouble,
                       std::vector<std::string>* warnings);

/// Several meshes, and files beside them, that appear together or not at all.
class MeshSequence {
public:
    explicit MeshSequence(bool isDouble) : _isDouble(isDouble) {}

    /// Writes a mesh under a temporary name. \throws Error as WriteMesh
    void Add(std::string const& path, Scene const& scene, std::vector<std::string>* warnings);

    /// Writes another file under a temporary name. \throws Error Io
    void Add(std::string const& path, std::string const& bytes);

    /// Makes room for a file that someone else writes. Returns its temporary name. \throws Error Io
    std::string const& Reserve(std::string const& path);

    /// Gives all of them their names. \throws Error Io; then none is left
    void Commit();

private:
    bool _isDouble;
    std::vector<std::unique_ptr<AtomicFile>> _files;
    std::vector<std::string> _paths;
};

}  // namespace limn::engine
