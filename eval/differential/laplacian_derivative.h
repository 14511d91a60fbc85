// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "eval/differential/lanes.h"
#include "eval/differential/multigrid_levels.h"
#include "far_ext/differential/laplacian.h"

namespace limn::eval {

using LaneRows = std::vector<DoubleLanes>;

/// How an area Laplacian (far_ext/differential/laplacian.h) changes when vertices move: a linear
/// map from moves to changes of g = rows * V and of areas at vertices, for given positions V.
///
/// Shape    a row of lanes per row of a MultigridLevel. Moves and gradients have three lanes and a
///          fourth that is 0; changes and factors have three for g and the fourth for the area.
///          Rows of fixed vertices must be 0 in what comes in; nothing is written to them.
/// Threads  rows are shared out to the calling arena's, with the same bits whatever their number.
class LaplacianDerivative {
public:
    virtual ~LaplacianDerivative() = default;

    virtual void Apply(LaneRows const& move, LaneRows& change) const = 0;

    /// The transpose: factors of (dg, dA) per row to the gradient of their sum by moves.
    virtual void ApplyTransposed(LaneRows const& factors, LaneRows& gradient) const = 0;
};

/// Of BuildCotangentLaplacian; areas are its mixed ones.
///
/// \param graph   of the level; kept by reference
/// \param rowsOf  per vertex its row
std::unique_ptr<LaplacianDerivative> DifferentiateCotangents(Far::TopologyLevel const& level,
                                                             MultigridLevel const& graph,
                                                             std::span<Index const> rowsOf,
                                                             std::span<double const> positions);

/// Of BuildHeatLaplacian, of the weights it kept; areas are FindVertexAreas'.
///
/// \param laplacian, kernel  what BuildHeatLaplacian has made for these positions
std::unique_ptr<LaplacianDerivative> DifferentiateHeat(Far::TopologyLevel const& level,
                                                       MultigridLevel const& graph,
                                                       std::span<Index const> rowsOf,
                                                       std::span<double const> positions,
                                                       far_ext::AreaLaplacian const& laplacian,
                                                       far_ext::HeatKernel const& kernel);

}  // namespace limn::eval
