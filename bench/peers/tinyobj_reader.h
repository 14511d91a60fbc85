// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <tiny_obj_loader.h>

#include "harness.h"

namespace limn::bench {

/// tinyobjloader's whole result of a file, polygons kept as they are.
struct TinyObj {
    explicit TinyObj(std::string const& path) {
        tinyobj::ObjReaderConfig config;
        config.triangulate = false;
        config.vertex_color = false;
        Check(reader.ParseFromFile(path, config), "tinyobjloader cannot read " + path);
    }

    size_t GetNumFaces() const {
        size_t num = 0;
        for (auto const& shape : reader.GetShapes()) num += shape.mesh.num_face_vertices.size();
        return num;
    }
    size_t GetNumCorners() const {
        size_t num = 0;
        for (auto const& shape : reader.GetShapes()) num += shape.mesh.indices.size();
        return num;
    }

    tinyobj::ObjReader reader;
};

}  // namespace limn::bench
