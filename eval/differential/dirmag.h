// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/rows/sparse_rows.h"

namespace limn::eval {

/// Differential coordinates as signed magnitudes and unit directions: delta_i = H_i n_i.
struct DirMag {
    std::vector<double> magnitudes;  ///< per vertex; positive where delta points out of the surface
    std::vector<double> directions;  ///< 3 per vertex, of length 1
    /// |tangential part of delta| / |delta|, norms over the mesh. Above kDirMagLimit tangential
    /// parts are taken for normals, and the result suffers.
    double tangentialShare = 0.0;
};

/// 0.04 to 0.51 on meshes where directions and magnitudes help, 0.84 where they destroy.
constexpr double kDirMagLimit = 0.6;

/// Unit normals, faces weighted by their angle at the vertex. Vertices without a normal get (0, 0,
/// 1).
///
/// \param positions  3 per vertex of the level
std::vector<double> FindAngleNormals(Far::TopologyLevel const& level,
                                     std::span<double const> positions);

/// Splits by angle-weighted normals; where delta is 0, below 1e-9 of the longest, or no longer than
/// `flat`, the direction is that normal.
///
/// Source  [Zhu11] Sec. 3.4
DirMag SplitDirMag(Far::TopologyLevel const& level, std::span<double const> positions,
                   std::span<double const> deltas, double flat = 0.0);

/// One step of subdivision: magnitudes by linear means, directions by weighted means on the sphere
/// (Buss and Fillmore's, to 1e-14). Directions whose linear mean vanishes give way to the one of
/// largest weight.
DirMag SubdivideDirMag(far_ext::SparseRows const& rows, DirMag const& coarse);

/// H n, 3 per vertex.
std::vector<double> JoinDirMag(DirMag const& split);

}  // namespace limn::eval
