// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/scene/model.h"

namespace limn::engine {

/// Something about a mesh that its maker should know.
struct Defect {
    std::string kind;    ///< non_manifold_edge, non_manifold_vertex, winding, not_orientable,
                         ///< repeated_corner, doubled_face, coincident_vertices,
                         ///< unreferenced_vertex, crease_without_edge
    Index element = -1;  ///< the first edge, vertex or face concerned
    uint32_t line = 0;   ///< in the file, where known
    size_t count = 1;    ///< how many elements have it
    std::string message;
};

/// All defects, one entry per kind.
std::vector<Defect> FindDefects(Model const& model);

}  // namespace limn::engine
