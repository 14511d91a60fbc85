// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/defects.h"
#include "engine/scene/model.h"
#include "engine/scene/uv_info.h"

namespace limn::engine {

struct MeshInfo {
    Index vertices = 0, edges = 0, faces = 0;
    std::map<int, Index> facesBySize;
    int components = 0, boundaryLoops = 0, eulerCharacteristic = 0;
    /// Summed over components, holes filled; none where not manifold or not orientable.
    std::optional<int> genus;
    int minValence = 0, maxValence = 0;
    size_t creases = 0, corners = 0, holes = 0;
    std::vector<std::string> groups;
    UVInfo uv;
    std::vector<Defect> defects;
};

MeshInfo DescribeMesh(Model const& model);

}  // namespace limn::engine
