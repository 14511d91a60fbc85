// SPDX-License-Identifier: Apache-2.0
#include "far_ext/differential/simple_edges.h"

#include <fmt/format.h>

#include "far_ext/error.h"
#include "far_ext/topology/boundary.h"

namespace limn::far_ext {

void RequireSimpleEdges(Far::TopologyLevel const& level, char const* rule) {
    CheckBoundary(level);
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        int const count = level.GetEdgeFaces(edge).size();
        if (count <= 2 && !level.IsEdgeNonManifold(edge)) continue;
        throw Error(ErrorCode::BadMesh, fmt::format("edge {} has {} faces; {} needs 1 or 2, wound "
                                                    "alike",
                                                    edge, count, rule));
    }
}

}  // namespace limn::far_ext
