// SPDX-License-Identifier: Apache-2.0
#include "far_ext/differential/simple_edges.h"

#include <string>

#include <fmt/format.h>

#include "far_ext/error.h"
#include "far_ext/topology/boundary.h"

namespace limn::far_ext {

void RequireSimpleEdges(Far::TopologyLevel const& level, char const* rule) {
    CheckBoundary(level);
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        int const count = level.GetEdgeFaces(edge).size();
        if (count <= 2 && !level.IsEdgeNonManifold(edge)) continue;
        auto const ends = level.GetEdgeVertices(edge);
        std::string const what = count > 2
                                     ? fmt::format("has {} faces", count)
                                     : std::string("joins faces wound in opposite directions");
        throw Error(ErrorCode::BadMesh,
                    fmt::format("the edge from vertex {} to {} {}; {} needs one or two faces at an "
                                "edge, wound alike",
                                ends[0], ends[1], what, rule));
    }
}

}  // namespace limn::far_ext
