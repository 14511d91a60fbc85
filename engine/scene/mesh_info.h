// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "engine/scene/defects.h"
#include "engine/scene/scene.h"
#include "engine/scene/uv_info.h"

namespace limn::engine {

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
