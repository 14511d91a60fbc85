// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "engine/io/mesh_reader.h"
#include "engine/scene/scene.h"

namespace limn::engine {

/// What turns a MESH of the command line into a mesh.
class MeshSource {
public:
    virtual ~MeshSource() = default;

    /// \param mesh    as the user wrote it, by which messages call the result
    /// \throws Error
    virtual Scene Read(std::string const& mesh) = 0;
};

/// The files that ReadMesh reads.
class MeshFiles : public MeshSource {
public:
    Scene Read(std::string const& mesh) override { return ReadMesh(mesh); }
};

}  // namespace limn::engine
