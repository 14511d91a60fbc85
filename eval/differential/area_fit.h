// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "eval/differential/multigrid.h"
#include "far_ext/differential/laplacian.h"

namespace limn::eval {

struct AreaFitOptions {
    double tolerance = 1e-4;  ///< stop where the residual is below it, or a step moves less than
                              ///< this times the box
    int maxSteps = 20;
};

struct AreaFitReport {
    int steps = 0, iterations = 0;  ///< of the fit, and of all linear solves together
    /// |Delta - A^-1 L V| / |Delta|, norms weighted by area. What remains is not reachable on this
    /// mesh: twice as many equations as a surface has shapes.
    double residual = 0.0, initialResidual = 0.0;
    bool converged = false;
};

/// Makes a Laplacian of the last level from positions.
using LaplacianBuilder = std::function<far_ext::AreaLaplacian(std::span<double const> positions)>;

/// Reconstruction where the Laplacian depends on the unknown positions: least squares of
///     A(V)^-1 L(V) V = Delta
/// by Gauss-Newton steps. Each minimises the linearised misfit over a Krylov space: flexible GMRES,
/// preconditioned by the multigrid with the cotangent weights of V, derivatives by differences. A
/// step is halved until the sum of squares falls.
///
/// Boundary  fixed where it comes in
/// Source    [Zhu11] Sec. 3.3, eq. (6) and (7)
///
/// \param refiner    of triangles, uniformly refined, with the last level's full topology
/// \param multigrid  of the refiner with a fixed boundary; its weights are replaced
/// \param build      the Laplacian to fit: cotangent or mesh Laplace operator
/// \param deltas     3 per vertex of the last level, about 2 H n
/// \param positions  where to start (the combinatorial solution), then the result
/// \throws Error     BadMesh, Unsupported: those of BuildCotangentLaplacian for the start
AreaFitReport FitAreaLaplacian(Far::TopologyRefiner const& refiner, Multigrid& multigrid,
                               LaplacianBuilder const& build, std::span<double const> deltas,
                               std::span<double> positions, AreaFitOptions const& options = {});

}  // namespace limn::eval
