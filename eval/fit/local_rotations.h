// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/types.h"

namespace limn::eval {

/// Per vertex the rotation that best takes its surroundings in one mesh into those in another of
/// the same faces: of H = sum over edge neighbours w of (from_w - from_v) (to_w - to_v)^T + mu n
/// n'^T the factor R = V diag(1, 1, det) U^T, H = U S V^T; n and n' are the area-weighted normals,
/// mu the mean of the products of the edges' lengths.
///
/// A vertex without edges, or all of whose edges have no length, is not turned.
///
/// Moves    turning and moving either mesh turns the rotations along with it, and nothing else.
/// Threads  the same bits for any pool size.
/// Source   [Limit 7]
class LocalRotations {
public:
    /// \param level     topology of both meshes
    /// \param from, to  3 numbers per vertex; finite
    LocalRotations(Far::TopologyLevel const& level, std::span<double const> from,
                   std::span<double const> to);

    /// Turns a vector per vertex, in place.
    void Apply(std::span<double> vectors) const;

    /// Of all vertices, in degrees.
    double FindLargestTurn() const;

private:
    std::vector<Eigen::Matrix3d> _rotations;
};

}  // namespace limn::eval
