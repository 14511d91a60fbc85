// SPDX-License-Identifier: Apache-2.0
#include "far_ext/forms/hodge_star.h"

#include <algorithm>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "far_ext/error.h"
#include "far_ext/rows/points.h"

namespace limn::far_ext {

HodgeStars FindHodgeStars(Far::TopologyLevel const& level, std::span<double const> positions) {
    Points const points(positions);
    HodgeStars stars;
    stars.edge.assign(level.GetNumEdges(), 0.0);
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        auto const vertices = level.GetFaceVertices(face);
        auto const edges = level.GetFaceEdges(face);
        int const size = vertices.size();
        Eigen::Vector3d centre = Eigen::Vector3d::Zero();
        for (Index vertex : vertices) centre += points[vertex] / size;
        double area = 0.0, longest = 0.0;
        for (int j = 0; j < size; ++j) {
            Eigen::Vector3d const a = points[vertices[j]], b = points[vertices[(j + 1) % size]];
            double const length = (b - a).norm();
            if (!(length > 0.0)) {
                throw Error(
                    ErrorCode::BadMesh,
                    fmt::format("the edge from vertex {} to {} has no length; merge the two",
                                vertices[j], vertices[(j + 1) % size]));
            }
            area += 0.5 * (a - centre).cross(b - centre).norm();
            longest = std::max(longest, length);
            if (size == 3) {
                Eigen::Vector3d const p = a - points[vertices[(j + 2) % 3]],
                                      q = b - points[vertices[(j + 2) % 3]];
                stars.edge[edges[j]] += 0.5 * p.dot(q) / std::max(p.cross(q).norm(), 1e-300);
            } else {
                stars.edge[edges[j]] += (0.5 * (a + b) - centre).norm() / length;
            }
        }
        if (!(area > 1e-14 * longest * longest))
            throw Error(ErrorCode::BadMesh,
                        fmt::format("face {} has no area; remove it or move its vertices", face));
        stars.area.push_back(area);
    }
    double mean = 0.0;
    for (double star : stars.edge)
        mean += std::max(star, 0.0) / static_cast<double>(stars.edge.size());
    for (double& star : stars.edge) star = std::max(star, 1e-3 * mean);
    return stars;
}

}  // namespace limn::far_ext
