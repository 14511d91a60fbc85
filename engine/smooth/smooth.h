// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "engine/scene/job.h"
#include "engine/scene/scene.h"
#include "engine/smooth/filter_widths.h"
#include "engine/smooth/smooth_levels.h"
#include "eval/cascade/cascade.h"

namespace limn::engine {

struct SmoothOptions {
    int levels = 2;
    SmoothRefinement refinement = SmoothRefinement::Quadrisect;
    far_ext::BoundaryRule boundary = far_ext::BoundaryRule::Fixed;
    eval::CascadeSolver solver = eval::CascadeSolver::ConjugateGradients;
    int sweeps =
        0;  ///< on the finest level, coarser ones by eval::CountSweeps; 0: by one of the following
    int iterations = 0;       ///< the same on every level
    double tolerance = 1e-6;  ///< else: conjugate gradients to this residual
    bool isGraph = false;     ///< filters heights z over the plane of x and y
    bool keepsCreases = false;
    bool preservesVolume = false;  ///< of closed components
    bool limitsWidth =
        false;  ///< takes 0.95 of the critical width where the width asked for is above it
    bool keepsResult = false;  ///< goes on to the last level when a component shrinks below half
    bool isSingle = false;     ///< Jacobi sweeps in single precision
};

/// The closed component that shrank most.
struct SmoothShrinkage {
    Index firstVertex = -1;    ///< of the component, in the control mesh; -1 without any
    int level = 0;             ///< where it was least
    double radiusRatio = 1.0;  ///< mean distance from its middle, over that of the start surface
};

/// A volume that was to be preserved.
struct SmoothVolume {
    Index firstVertex = 0;
    double start = 0.0, end = 0.0;
    bool isMet = false;
};

struct SmoothReport {
    std::vector<eval::CascadeStepReport> levels;
    double meanEdge = 0.0;            ///< of the control mesh
    double largestWidth = 0.0;        ///< as used
    std::optional<double> limitedBy;  ///< factor on all widths that limitsWidth applied
    SmoothShrinkage shrinkage;
    std::optional<double> criticalFactor;  ///< measured: the largest factor, at most 1, on the
                                           ///< widths asked for that the closed components carry
    bool hasCollapsed =
        false;  ///< a component fell below half of its radius, or carries less than the width used
    std::vector<SmoothVolume> volumes;

    /// criticalFactor as a width. \pre there is one
    double GetCriticalWidth() const {
        return *criticalFactor * largestWidth / limitedBy.value_or(1.0);
    }
    bool HasConverged() const;  ///< and not collapsed
};

/// Refines a mesh and smooths it by curvature motion: the cascadic geometric filter.
///
/// Topology  of uniform refinement with the scene's scheme, or of bisection; positions start from
///           linear interpolation.
/// Result    an approximation of the filtered surface, with texture coordinates by the scene's rule
///           and, as primvar `width`, the filter width at each vertex. Creases and corners are left
///           out unless they were kept. Where a component collapsed and results are not to be kept,
///           an empty mesh.
///
/// Collapse  A width above what a closed component carries has no fixed point: it shrinks to
///           nothing with the levels. Where one shrank suspiciously, the critical width is measured
///           on a grid of 10 000 vertices at most [Cascade 7].
///
/// \param scene   of the scheme Loop where triangles are to stay triangles
/// \param job     told of progress, and of a metric that was frozen, sharp corners, volumes that
///                could not be kept
/// \throws Error  BadMesh: not manifold or oriented two ways; a width above 1e6 of the mesh's size;
///                for graphs, faces that overlap in the plane.  As SmoothLevels
/// Source  [Diewald02] Sec. 5 to 8; [Cascade 2], [Cascade 9]
Scene Smooth(Scene const& scene, Far::TopologyRefiner const& refiner, FilterWidths const& widths,
             SmoothOptions const& options, Job& job, SmoothReport& report);

}  // namespace limn::engine
