// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "engine/io/written_numbers.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "engine/smooth/smooth_levels.h"
#include "engine/smooth/widths.h"
#include "eval/cascade/cascade.h"
#include "eval/cascade/sweep_matrices.h"

namespace limn::engine {

/// Where conjugate gradients stop on every level.
struct StopAtResidual {
    double residual = 1e-6;
};

/// Sweeps or iterations on the finest level; coarser ones take more, by eval::CountSweeps.
struct SweepsOnFinest {
    int count = 1;
};

/// The same number of sweeps or iterations on every level.
struct IterationsPerLevel {
    int count = 1;
};

using SmoothStop = std::variant<StopAtResidual, SweepsOnFinest, IterationsPerLevel>;

/// What the surface has to keep.
enum class SmoothConstraint {
    None,
    Graph,  ///< heights z over the plane of x and y are filtered, x and y stay
    Volume  ///< closed components keep their volume
};

/// What to do where a closed component shrinks below half, or carries less than the width.
enum class OnCollapse {
    Stop,
    LimitWidth,  ///< takes 0.95 of the critical width
    KeepResult   ///< goes on to the last level
};

/// The width, over the mean edge length, where none is given: below what coarse closed meshes carry
/// [Cascade 7].
inline constexpr double kDefaultWidthFactor = 0.12;

struct SmoothOptions {
    int levels = 2;  ///< 0: the mesh stays as it is, and is solved on once
    /// Solves of width sigma / sqrt(steps) each, with metric and right side of the step before. The
    /// cascade is the first; the others run on its finest mesh.
    int steps = 1;
    /// Each step is repeated on the finest mesh, with the metric of what came out, until no vertex
    /// moves by more than this share of the bounding box's diagonal; 30 times at most.
    std::optional<double> settle{};
    /// 2: curvature motion. 4: (M + L M^-1 L) X = M X0, which keeps more of the volume, with a gain
    /// of 1/2 at the same wave length; without refinement only, steps are of sigma / steps^(1/4).
    int order = 2;
    /// Where normals turn by more over a length (1/length), the filter hardly acts; without
    /// refinement, on triangles only.
    std::optional<double> keptFeatures{};
    /// Cuts triangles only where they lie by more than this share of the bounding box's diagonal
    /// from the surface, about, in up to twice as many passes of bisection as levels; then lets it
    /// settle to a fifth of that. `refinement` means nothing then.
    std::optional<double> adaptive{};
    SmoothRefinement refinement = SmoothRefinement::Quadrisect;
    far_ext::BoundaryRule boundary = far_ext::BoundaryRule::Fixed;
    eval::CascadeSolver solver = eval::CascadeSolver::ConjugateGradients;
    SmoothStop stop{};  ///< the exact solver needs none; Jacobi sweeps are counted
    SmoothConstraint constraint = SmoothConstraint::None;
    OnCollapse onCollapse = OnCollapse::Stop;
    bool keepsCreases = false;
    Precision precision = Precision::Double;  ///< of Jacobi sweeps
    /// Applies interpolation and Jacobi sweeps as tables in float; null: none.
    eval::TableEvaluator* evaluator = nullptr;
    bool keepsSweeps = false;  ///< in the result, of Jacobi; with a solve per level only
    /// The file that the mesh is for: its coordinates are rounded to what that will hold. None:
    /// they stay doubles.
    std::optional<MeshTarget> target{};
};

/// The closed component that shrank most in a step.
struct SmoothShrinkage {
    Index firstVertex = 0;     ///< of the component, in the control mesh
    int level = 0;             ///< where it was least
    double radiusRatio = 1.0;  ///< mean distance from its middle, over that before the step
};

/// A solve of the cascade or of a later step, with the repetitions that settled it.
struct SmoothSolve : eval::CascadeStepReport {
    int level = 0, step = 1;
};

/// A volume that was to be preserved.
struct SmoothVolume {
    Index firstVertex = 0;
    double start = 0.0, end = 0.0;  ///< of the mesh as it is returned
    bool isMet = false;             ///< before it was rounded
};

/// What became of refining adaptively; errors are over the bounding box's diagonal.
struct SmoothAdaption {
    double estimated = 0.0;  ///< error left, about
    int passes = 0;
    Index vertices = 0;
    double smallestEdge = 0.0;
    double uniformVertices = 0.0;  ///< of quarterings as deep, two passes each
};

struct SmoothReport {
    std::vector<SmoothSolve> levels;
    std::vector<double> settleMoves;  ///< per repetition: the largest move over the diagonal
    std::optional<SmoothAdaption> adaption;
    Precision precision = Precision::Double;  ///< what the mesh's coordinates are rounded to
    double meanEdge = 0.0;                    ///< of the control mesh
    double largestWidth = 0.0;                ///< as used
    std::optional<double> limitedBy;          ///< factor on all widths that LimitWidth applied
    std::optional<SmoothShrinkage> shrinkage;
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

/// A sweep of a level, over the vertices that its refinement has.
struct LevelSweep {
    int level = 0;
    eval::SweepMatrices matrices;
};

struct SmoothResult {
    /// Without creases and corners unless they were kept; primvar `width` is the filter width at
    /// each vertex. None where a component collapsed, unless results are to be kept.
    std::optional<Scene> mesh;
    SmoothReport report;
    std::vector<LevelSweep> sweeps;  ///< where they were to be kept
};

/// Refuses options that do not go together. \throws Error  BadOption: both named
void CheckOptions(SmoothOptions const& options);

/// Refines a mesh and smooths it by curvature motion: the cascadic geometric filter.
///
/// Topology  of uniform refinement with the model's scheme, or of bisection; positions start from
///           linear interpolation.
/// Result    an approximation of the filtered surface, with texture coordinates by the model's
///           rule.
/// Fairing   Without refinement faces must be all triangles or all quads. A single solve exists for
///           every width, so that nothing collapses unless it is to settle.
/// Collapse  A width above what a closed component carries has no fixed point: it shrinks to
///           nothing with the levels. Where one shrank suspiciously, the critical width is measured
///           on a grid of 10 000 vertices at most [Cascade 7].
///
/// \param model   of the scheme Loop where triangles are to stay triangles
/// \param job     told of progress, and of a metric that was frozen, sharp corners, volumes that
///                could not be kept, a precision that was not asked for or loses too much
/// \throws Error  BadMesh: not manifold or oriented two ways; without refinement, other faces; a
/// width above 1e6 of the mesh's size;
///                for graphs, faces that overlap in the plane.  BadOption: a width that is no
///                number from 0 up, a residual for Jacobi sweeps, widths for another number of
///                vertices, options that do not go together.  As SmoothLevels
/// \throws Stopped
/// Source  [Diewald02] Sec. 5 to 8; [Cascade 2], [Cascade 9]
SmoothResult Smooth(Model const& model, FilterWidths const& widths, SmoothOptions const& options,
                    Job& job);

}  // namespace limn::engine
