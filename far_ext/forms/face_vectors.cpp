// SPDX-License-Identifier: Apache-2.0
#include "far_ext/forms/face_vectors.h"

#include <algorithm>
#include <vector>

#include <Eigen/Dense>

#include "far_ext/forms/form_operators.h"
#include "far_ext/rows/points.h"

namespace limn::far_ext {

namespace {

using Vectors = std::vector<Eigen::Vector3d>;

/// ((S/3 - beta) (b-a)^perp + (S/3 - gamma) (c-a)^perp) / 2A with alpha on b->c, beta on c->a,
/// gamma on a->b: by side.
Vectors MakeWhitney(Vectors const& corners, Eigen::Vector3d const& areaVector) {
    Eigen::Vector3d const normal = areaVector.normalized();
    double const twiceArea = 2.0 * areaVector.norm();
    Eigen::Vector3d const p = normal.cross(corners[1] - corners[0]) / twiceArea,
                          q = normal.cross(corners[2] - corners[0]) / twiceArea;
    // Sides in order: gamma, alpha, beta.
    return {p / 3.0 - q * (2.0 / 3.0), (p + q) / 3.0, q / 3.0 - p * (2.0 / 3.0)};
}

/// M^-1 sum e w for the sides e in the plane, M = sum e e^T.
Vectors MakeLeastSquares(Vectors const& corners, Eigen::Vector3d const& areaVector) {
    Eigen::Vector3d const normal = areaVector.normalized();
    Eigen::Matrix3d moments = normal * normal.transpose();  // regular across the plane, too
    Vectors sides;
    for (size_t j = 0; j < corners.size(); ++j) {
        Eigen::Vector3d side = corners[(j + 1) % corners.size()] - corners[j];
        side -= normal * normal.dot(side);
        sides.push_back(side);
        moments += side * side.transpose() / areaVector.norm();
    }
    Eigen::Matrix3d const inverse = moments.inverse() / areaVector.norm();
    for (Eigen::Vector3d& side : sides) side = inverse * side;
    return sides;
}

/// Whether the area vector says where a face lies: quads that cross themselves may have none,
/// though each of their triangles has an area.
bool HasPlane(Vectors const& corners, Eigen::Vector3d const& areaVector) {
    double longest = 0.0;
    for (size_t j = 0; j < corners.size(); ++j)
        longest = std::max(longest, (corners[(j + 1) % corners.size()] - corners[j]).squaredNorm());
    return areaVector.norm() > 1e-14 * longest;  // as FindHodgeStars asks of areas
}

Vectors MakeWeights(Vectors const& corners) {
    Eigen::Vector3d areaVector = Eigen::Vector3d::Zero();
    for (size_t j = 2; j < corners.size(); ++j)
        areaVector += 0.5 * (corners[j - 1] - corners[0]).cross(corners[j] - corners[0]);
    if (!HasPlane(corners, areaVector)) return {corners.size(), Eigen::Vector3d::Zero()};
    return corners.size() == 3 ? MakeWhitney(corners, areaVector)
                               : MakeLeastSquares(corners, areaVector);
}

}  // namespace

SparseRows BuildFaceVectors(Far::TopologyLevel const& level, std::span<double const> positions) {
    Points const points(positions);
    SparseRows rows;
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        Vectors corners;
        for (Index vertex : level.GetFaceVertices(face)) corners.emplace_back(points[vertex]);
        Vectors const weights = MakeWeights(corners);
        for (int axis = 0; axis < 3; ++axis) {
            for (size_t j = 0; j < weights.size(); ++j) {
                OrientedEdge const side = GetFaceSide(level, face, static_cast<int>(j));
                rows.indices.push_back(side.edge);
                rows.weights.push_back(side.sign * weights[j][axis]);
            }
            rows.offsets.push_back(static_cast<int>(rows.indices.size()));
        }
    }
    return rows;
}

}  // namespace limn::far_ext
