// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/types.h"

namespace limn::eval {

/// Curvature of a polygon mesh per vertex, in 1/length, by the tensor of its dihedral angles:
///     T = (1/A) sum over edges of |e|/2 beta e e^T, projected on the tangent plane,
/// with A the vertex's share of its faces' areas. Where the mesh is a dense sampling of a smooth
/// surface it is that surface's. Vertices on a boundary, at an edge of more than two faces or
/// without a face have none.
///
/// Source  [Zhu11] Sec. 4.3, its reference [39]
struct MeshCurvature {
    std::vector<double> areas;  ///< per vertex; 0 where it has no curvature
    std::vector<double> k1,
        k2;  ///< k1 >= k2; positive where the mesh is convex seen from outside; 0 without
    double GetMean(size_t vertex) const { return 0.5 * (k1[vertex] + k2[vertex]); }
    double GetGaussian(size_t vertex) const { return k1[vertex] * k2[vertex]; }
};

/// \param positions    3 per vertex of the level
MeshCurvature MeasureMeshCurvature(Far::TopologyLevel const& level,
                                   std::span<double const> positions,
                                   Orientation orientation = Orientation::Right);

/// Thin-plate energy: the area-weighted mean of k1^2 + k2^2 (1/length^2), and its integral, which
/// has no scale.
struct ThinPlateEnergy {
    double mean = 0.0, integral = 0.0;
};

ThinPlateEnergy FindThinPlateEnergy(MeshCurvature const& curvature);

/// Area vectors of faces: normals as long as the area.
std::vector<double> FindFaceNormals(Far::TopologyLevel const& level,
                                    std::span<double const> positions);

}  // namespace limn::eval
