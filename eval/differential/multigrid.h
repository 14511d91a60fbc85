// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "eval/differential/lanes.h"
#include "eval/differential/multigrid_levels.h"

namespace limn::eval {

/// What became of an iteration. Not converging is an answer: the caller decides.
struct MultigridReport {
    int iterations = 0;
    double residual = 0.0;  ///< |b - G x| / |b| of the solution handed back; where b = 0, over what
                            ///< it started from
    /// What the residual may be because the solution's numbers are doubles: grows with the distance
    /// from the origin, and by 4 from level to level where b is 4^-k of a right-hand side.
    double rounding = 0.0;
    bool converged = false;  ///< residual <= the larger of tolerance and rounding
};

struct MultigridOptions {
    double tolerance = 1e-8;
    int maxIterations = 60;
};

/// Weights of one level's equation.
struct EdgeWeights {
    std::vector<double> edges;   ///< per edge of the level
    std::vector<double> masses;  ///< per vertex, added to the diagonal; may be empty
};

/// Solves G x = b for three right-hand sides together on the last level of a uniform refinement,
/// where
///     (G x)_i = m_i x_i + sum over edges (i,j) of w_ij (x_i - x_j),
/// by conjugate gradients in double, preconditioned by a V-cycle in float on the refinement's own
/// levels: Chebyshev smoothing, a sparse Cholesky factorisation on the coarsest. Without weights w
/// = 1 and m = 0, and no level stores any.
///
/// Singular  Where constants are free (MultigridLevel::Block), b is projected onto the range (b
///           less its mean), and one vertex, the block's anchor, keeps the value it came with.
/// Origin    What all of a solution has in common costs no digits but those of its own numbers.
/// Threads   Solve runs on the calling arena's threads, with the same bits whatever their number;
///           one Solve at a time.
/// Memory    About 250 bytes per unknown on triangles.
class Multigrid {
public:
    /// \param refiner   uniformly refined, with the last level's full topology; not kept
    /// \param coarsest  the level that is factorised. With the last one the solver is sparse
    ///                  Cholesky: the reference, and fastest below some hundred unknowns
    /// \throws Error    BadMesh: an equation of the coarsest level that no factorisation exists for
    Multigrid(Far::TopologyRefiner const& refiner, FixedVertices fixed, int coarsest = 0);
    ~Multigrid();
    Multigrid(Multigrid&&) noexcept;

    /// Replaces the weights, one entry per level from the coarsest; the numbering stays.
    ///
    /// \throws Error  BadOption if sizes do not fit; BadMesh as the constructor, or for a row
    ///                without a positive diagonal
    void SetWeights(Far::TopologyRefiner const& refiner, std::vector<EdgeWeights> const& weights);

    /// Chooses anchors; until then they are the first rows.
    ///
    /// \param vertices  one of the last level per singular block, in the order of blocks
    void SetAnchors(std::span<Index const> vertices);

    /// \param rightSide  3 per vertex of the last level; entries of fixed vertices are not read
    /// \param solution   3 per vertex: what to start from, and the result. Fixed vertices keep
    ///                   theirs, and their neighbours see it
    MultigridReport Solve(std::span<double const> rightSide, std::span<double> solution,
                          MultigridOptions const& options = {});

    /// One V-cycle: an approximate inverse of G, the same symmetric map for every right-hand side.
    ///
    /// \param rightSide, result  in rows of the last level; those of fixed vertices are not used
    void Precondition(std::vector<DoubleLanes> const& rightSide, std::vector<DoubleLanes>& result);

    /// Takes constants from rows of the last level where they are free, so that anchors have 0.
    void HoldAnchors(std::vector<DoubleLanes>& rows) const;

    std::vector<MultigridLevel> const& GetLevels() const;

    /// Bytes held for solving, numbering included.
    size_t GetNumBytes() const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> _implementation;
};

}  // namespace limn::eval
