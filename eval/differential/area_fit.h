// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "eval/differential/multigrid.h"

namespace limn::eval {

/// The Laplacians that know areas: BuildCotangentLaplacian and BuildHeatLaplacian.
enum class AreaLaplacianKind { Cotangent, Heat };

struct AreaFitOptions {
    double tolerance = 1e-4;  ///< of the residual
    int maxSteps = 50;
    std::function<void()> onWork{};  ///< called between applications of the derivative; may throw
};

struct AreaFitReport {
    int steps = 0, iterations = 0;  ///< steps taken, and iterations of all their linear solves
    /// |Delta - M L V| / |Delta|, norms weighted by the areas at vertices where the fit began: what
    /// collapses gains nothing.
    double residual = 0.0, initialResidual = 0.0;
    bool converged = false;   ///< residual <= tolerance
    bool hasStalled = false;  ///< ended since steps gained little more
};

/// Reconstruction where the Laplacian depends on the unknown positions: least squares of
///     M(V) L(V) V = Delta
/// by Levenberg and Marquardt's method with the whole derivative. Moves are measured by what they
/// do to differential coordinates, through the multigrid with the cotangent weights of V: its
/// damping holds back rough moves and smooth ones alike, and conjugate gradients need few
/// iterations.
///
/// There may be no solution: twice as many equations as a surface has shapes.
///
/// Boundary  fixed where it comes in; so are the multigrid's anchors
/// Source    [Zhu11] Sec. 3.3, eq. (6) and (7); [Differential 6]
///
/// \param refiner    of triangles, uniformly refined, with the last level's full topology
/// \param multigrid  of the refiner with a fixed boundary; its weights are replaced
/// \param deltas     3 per vertex of the last level, about 2 H n
/// \param positions  where to start (the combinatorial solution), then the result
/// \throws Error     BadMesh, Unsupported: BuildCotangentLaplacian's for the start; onWork's
AreaFitReport FitAreaLaplacian(Far::TopologyRefiner const& refiner, Multigrid& multigrid,
                               AreaLaplacianKind kind, std::span<double const> deltas,
                               std::span<double> positions, AreaFitOptions const& options = {});

}  // namespace limn::eval
