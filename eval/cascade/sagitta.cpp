// SPDX-License-Identifier: Apache-2.0
#include "eval/cascade/sagitta.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "far_ext/cascade/edge_numbers.h"
#include "far_ext/rows/points.h"

namespace limn::eval {

namespace {

/// An edge with the corners from which triangles run along it; -1 for the second of a boundary.
struct SharedEdge {
    std::array<Index, 2> ends;
    std::array<Index, 2> corners;
    bool isCrease = false;
};

struct SharedEdges {
    std::vector<SharedEdge> edges;

    explicit SharedEdges(SagittaMesh const& mesh) {
        far_ext::EdgeNumbers numbers(static_cast<Index>(mesh.positions.size() / 3));
        auto const numCorners = static_cast<Index>(mesh.faces.size());
        for (Index corner = 0; corner < numCorners; ++corner) {
            Index const next = corner % 3 == 2 ? corner - 2 : corner + 1;
            std::array<Index, 2> const ends{mesh.faces[corner], mesh.faces[next]};
            Index const edge = numbers.Get(ends[0], ends[1]);
            if (static_cast<size_t>(edge) == edges.size())
                edges.push_back({ends, {corner, -1}});
            else
                edges[edge].corners[1] = corner;
        }
        for (auto const& crease : mesh.creases) {
            Index const edge = numbers.Find(crease[0], crease[1]);
            if (edge >= 0) edges[edge].isCrease = true;
        }
    }
};

/// tan(theta/4) of the angle between two vectors, without a function whose bits depend on the CPU.
double FindQuarterTangent(Eigen::Vector3d const& a, Eigen::Vector3d const& b) {
    double const sine = a.cross(b).norm(), cosine = a.dot(b);
    double const half = std::sqrt(a.squaredNorm() * b.squaredNorm()) + cosine;  // of tan(theta/2)
    double const below = half + std::sqrt(half * half + sine * sine);
    if (below > 0.0) return sine / below;
    return cosine < 0.0 ? 1.0 : 0.0;  // folded back; or a triangle without area
}

}  // namespace

std::vector<double> FindSagittas(SagittaMesh const& mesh) {
    far_ext::Points const points(mesh.positions);
    size_t const numFaces = mesh.faces.size() / 3;
    std::vector<Eigen::Vector3d> areas(numFaces), normals(points.GetCount(), {0.0, 0.0, 0.0});
    for (size_t face = 0; face < numFaces; ++face) {
        Index const* const f = &mesh.faces[3 * face];
        areas[face] = (points[f[1]] - points[f[0]]).cross(points[f[2]] - points[f[0]]);
        for (size_t k = 0; k < 3; ++k) normals[f[k]] += areas[face];
    }
    for (Eigen::Vector3d& normal : normals) normal.stableNormalize();

    std::vector<double> sagittas(numFaces, 0.0);
    for (SharedEdge const& edge : SharedEdges(mesh).edges) {
        auto const [a, b] = edge.ends;
        Index const first = edge.corners[0] / 3,
                    second = edge.corners[1] < 0 ? first : edge.corners[1] / 3;
        double const reach = std::max(mesh.reach[first], mesh.reach[second]);
        Eigen::Vector3d const along = points[b] - points[a];
        double sagitta = std::abs((normals[b] - normals[a]).dot(along)) / 8.0;
        if (second != first && !edge.isCrease) {
            double const length = along.norm();
            double const height =
                length > 0.0 ? (areas[first].norm() + areas[second].norm()) / (2.0 * length) : 0.0;
            double const across = FindQuarterTangent(areas[first], areas[second]) * height / 2.0;
            sagitta = std::max(sagitta, across);
        }
        sagitta = std::min(sagitta, reach);
        for (Index face : {first, second}) sagittas[face] = std::max(sagittas[face], sagitta);
    }
    return sagittas;
}

}  // namespace limn::eval
