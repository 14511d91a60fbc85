// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/rows/sparse_rows.h"

namespace limn::far_ext {

// Three discrete Laplacians of a level of a refinement. Each turns points v into differential
// coordinates
//     delta_i = sum_j w_ij (v_i - v_j),
// which point out of the surface where it is convex.
//
// Shape     n rows over n vertices of the level; a row adds up to 0.
// Boundary  delta_i = v_i - (a + b) / 2 for the two neighbours a, b along the boundary: the rule of
//           curves. Rows of vertices without an edge are empty.
// Errors    BadMesh, for all of them: that of CheckBoundary (topology/boundary.h).
// Source    [Zhu11] Sec. 3.1 and 3.5 (boundary).

/// Combinatorial: w_ij = 1/d over the d edges of vertex i, for faces of any size. No unit.
SparseRows BuildCombinatorialLaplacian(Far::TopologyLevel const& level);

/// The differential coordinates of points, 3 per vertex: sums of w_ij (v_i - v_j), so that a mesh
/// far from the origin has those of the same mesh near it.
std::vector<double> FindDeltas(SparseRows const& laplacian, std::span<double const> positions);

/// A Laplacian that knows areas: delta_i = (1/area_i) * row i, about 2 H n for mean curvature H
/// (1/length). Rows and areas of boundary vertices are those of the curve rule, and 1.
struct AreaLaplacian {
    SparseRows rows;
    std::vector<double> areas;
};

/// Cotangent weights (cot a + cot b) / 2, with mixed Voronoi areas (Voronoi; half or a quarter of
/// the triangle where it is obtuse).
///
/// \param positions  3 per vertex of the level
/// \throws Error     Unsupported: a face that is no triangle.  BadMesh: a triangle without area, by
///                   its number
/// Source  [Zhu11] Sec. 3.1, its references [30] and [31]
AreaLaplacian BuildCotangentLaplacian(Far::TopologyLevel const& level,
                                      std::span<double const> positions);

/// Its weights alone, per edge of the level.
std::vector<double> FindCotangentWeights(Far::TopologyLevel const& level,
                                         std::span<double const> positions);

/// A third of the areas of the triangles at each vertex.
///
/// \throws Error  as BuildCotangentLaplacian
std::vector<double> FindVertexAreas(Far::TopologyLevel const& level,
                                    std::span<double const> positions);

/// How the mesh Laplace operator was cut off.
struct HeatKernel {
    double time = 0.0;    ///< t: the square of the mean edge length
    double radius = 0.0;  ///< beyond it weights are left out
    /// What was left out of row i adds up to at most this times the farthest distance between two
    /// vertices.
    double truncation = 0.0;
};

/// The mesh Laplace operator: w_ij = A_j / (4 pi t^2) exp(-|v_i - v_j|^2 / 4t) with A_j a third of
/// the areas at j, over all j nearer than `radius`; areas are 1. Weights left out are each below
/// 1e-6 of the kernel's middle.
///
/// \param kernel  receives t, the radius and the bound; may be null
/// \throws Error  as BuildCotangentLaplacian; TooLarge: more than 2^31 weights, some 200 per vertex
/// Source  [Zhu11] Sec. 3.1, its reference [33]
AreaLaplacian BuildHeatLaplacian(Far::TopologyLevel const& level, std::span<double const> positions,
                                 HeatKernel* kernel = nullptr);

}  // namespace limn::far_ext
