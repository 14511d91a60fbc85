// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "engine/scene/scene.h"

namespace limn::engine {

/// Something about a mesh that its maker should know.
struct Defect {
    std::string kind;    ///< non_manifold_edge, non_manifold_vertex, winding, not_orientable,
                         ///< repeated_corner, unreferenced_vertex, crease_without_edge
    Index element = -1;  ///< the first edge, vertex or face concerned
    uint32_t line = 0;   ///< in the file, where known
    size_t count = 1;    ///< how many elements have it
    std::string message;
};

/// All defects, one entry per kind.
///
/// \param level  the base level of the scene's refiner
std::vector<Defect> FindDefects(Scene const& scene, Far::TopologyLevel const& level);

struct UVInfo {
    bool present = false;
    std::vector<int> tiles;
    size_t overlapFaces = 0, flippedFaces = 0, zeroAreaFaces = 0, outOfRangeFaces = 0;
};

struct MeshInfo {
    Index vertices = 0, edges = 0, faces = 0;
    std::map<int, Index> facesBySize;
    int components = 0, boundaryLoops = 0, eulerCharacteristic = 0;
    int genus =
        -1;  ///< summed over components, holes filled; -1 where not manifold or not orientable
    int minValence = 0, maxValence = 0;
    size_t creases = 0, corners = 0, holes = 0;
    std::vector<std::string> groups;
    UVInfo uv;
    std::vector<Defect> defects;
};

MeshInfo DescribeMesh(Scene const& scene, Far::TopologyLevel const& level);

}  // namespace limn::engine
