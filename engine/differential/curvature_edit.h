// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <opensubdiv/far/topologyLevel.h>

#include "far_ext/types.h"

namespace limn::engine {

/// Changes to differential coordinates before they are subdivided, by vertices of the input. A
/// coordinate is H u: along u, its direction where it points out of the surface (the normal, where
/// the surface is flat), as long as H. Lists are applied in this order, the filter last.
struct CurvatureEdit {
    struct Mean {
        Index vertex;
        double
            mean;  ///< curvature, 1/length; positive where the surface bends away from its normal
    };
    struct Factor {
        Index vertex;
        double factor;  ///< on H, also on one that was set
    };
    struct Normal {
        Index vertex;
        std::array<double, 3> normal;  ///< u, of any length
    };
    struct Rotation {
        Index vertex;
        std::array<double, 3> axis;
        double degrees;  ///< of u
    };
    std::vector<Mean> means;
    std::vector<Factor> factors;
    std::vector<Normal> normals;
    std::vector<Rotation> rotations;
    /// All H, brought to [0, 1], through [Zhu11] Sec. 4.4's filter
    bool isPolarised = false;
    /// or through the monotone curve of these points (x, y).
    std::vector<std::array<double, 2>> filterPoints;

    /// All vertices that it names, in the order of its lists.
    std::vector<Index> ListVertices() const;
    bool IsEmpty() const { return ListVertices().empty() && !isPolarised && filterPoints.empty(); }
};

/// [Zhu11] Sec. 4.4: 1/2 +- (|x - 1/2| / 8)^(1/4), which pushes values apart around the middle.
double PolariseCurvature(double x);

/// What the lists of an edit, without its filter, ask of a vertex: mean curvature, or a unit
/// normal.
struct EditTarget {
    Index vertex;
    std::variant<double, std::array<double, 3>> asked;
};

/// Where coordinates lie.
struct EditedLevel {
    Far::TopologyLevel const& level;     ///< its first vertices are the input's
    std::span<double const> positions;   ///< 3 per vertex
    std::vector<double> lengthsPerMean;  ///< per vertex: H over the mean curvature it stands for
    Orientation orientation = Orientation::Right;
};

/// H of the combinatorial Laplacian over mean curvature: half the mean squared length of the edges
/// at each vertex.
std::vector<double> FindCombinatorialLengths(Far::TopologyLevel const& level,
                                             std::span<double const> positions);

/// Changes coordinates. Those of vertices that lists do not name stay to the bit, without a filter.
///
/// \param deltas   3 per vertex
/// \return         what is asked for, each vertex once per kind: means before normals, in the order
///                 of the lists
/// \throws Error   BadMesh: a coordinate that would be 1e30 times as long as the mesh, or longer;
///                 named by vertex after `path`
std::vector<EditTarget> ApplyEdit(CurvatureEdit const& edit, EditedLevel const& on,
                                  std::string const& path, std::vector<double>& deltas);

}  // namespace limn::engine
