// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "eval/differential/multigrid.h"

namespace limn::eval {

struct ReconstructReport {
    int iterations = 0;
    /// |L V - Delta| / |Delta| of the positions handed back, over vertices inside, rows weighted by
    /// their degree, after projection.
    double residual = 0.0;
    double rounding = 0.0;  ///< what of it the positions' being doubles may account for
    /// What no mesh can have of the differential coordinates and projection takes away: the largest
    /// of |sum d Delta| / sum d |Delta| over closed components and boundary loops.
    double compatibilityDefect = 0.0;
    bool converged = false;
};

/// Finds the positions on a refinement's last level that have given combinatorial differential
/// coordinates.
///
/// Boundary  Each boundary loop is a curve of its own and found first, exactly; what lies inside
///           follows with the loop fixed.
/// Placing   Differential coordinates do not know translations: per closed component and per
///           boundary loop one vertex, the handle, stays where it was.
/// Re-edit   Solve again with other coordinates: nothing is set up anew.
/// Source    [Zhu11] Sec. 3.5, step 4, with the projection in place of least squares (equal to
///           rounding)
class Reconstructor {
public:
    /// \param refiner   uniformly refined, with the last level's full topology; not kept
    /// \param coarsest  see Multigrid
    /// \param handles   vertices of the base level, at most one per closed component or loop;
    ///                  others get their lowest vertex
    /// \throws Error    BadOption: two handles of one component or loop, or one inside of a
    ///                  component that its boundary holds.  BadMesh: a vertex where boundaries meet
    Reconstructor(Far::TopologyRefiner const& refiner, std::span<Index const> handles = {},
                  int coarsest = 0);

    /// \param deltas     3 per vertex of the last level: differential coordinates there, already
    ///                   scaled (4^-k)
    /// \param positions  3 per vertex: where to start and where handles lie, then the result.
    ///                   Vertices without an edge stay
    ReconstructReport Solve(std::span<double const> deltas, std::span<double> positions,
                            MultigridOptions const& options = {});

    Multigrid& GetMultigrid() { return _multigrid; }
    std::vector<Index> const& GetHandles() const { return _handles; }  ///< on the last level

private:
    void ChooseHandles(Far::TopologyRefiner const& refiner, std::span<Index const> handles);
    double SolveLoop(std::vector<Index> const& loop, Index handle, std::span<double const> deltas,
                     std::span<double> positions) const;
    double ProjectBlock(MultigridLevel::Block const& block, std::span<double> rightSide) const;

    Multigrid _multigrid;
    std::vector<std::vector<Index>> _loops;  // of the last level
    std::vector<Index> _handles;             // first those of loops, then those of singular blocks
};

}  // namespace limn::eval
