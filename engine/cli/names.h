// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/bake/bake_options.h"
#include "engine/differential/differential.h"
#include "engine/field/field.h"
#include "engine/measure/measure.h"
#include "engine/smooth/smooth.h"
#include "far_ext/enum_words.h"

namespace limn::cli {

// The words that only the command line has. Those that files and reports have, too, lie beside what
// they name.

inline constexpr auto kPrecisionWords = MakeEnumWords<Precision>(
    "precision", {{Precision::Float, "float"}, {Precision::Double, "double"}});

inline constexpr auto kVectorSpaceWords =
    MakeEnumWords<engine::VectorSpace>("space", {{engine::VectorSpace::Object, "object"},
                                                 {engine::VectorSpace::Tangent, "tangent"},
                                                 {engine::VectorSpace::UV, "uv"}});

inline constexpr auto kMeasuredSurfaceWords = MakeEnumWords<engine::MeasuredSurface>(
    "surface",
    {{engine::MeasuredSurface::Limit, "limit"}, {engine::MeasuredSurface::Mesh, "mesh"}});

inline constexpr auto kAtBoundaryWords = MakeEnumWords<eval::AtBoundary>(
    "atBoundary", {{eval::AtBoundary::Tangent, "tangent"}, {eval::AtBoundary::Normal, "normal"}});

/// What the pixels of a field's image are: vectors in object space, or flow in texture coordinates.
inline constexpr auto kIsFlowWords =
    MakeEnumWords<bool>("isFlow", {{false, "object"}, {true, "uv"}});

/// Which way streamlines run from their seeds.
inline constexpr auto kIsForwardOnlyWords =
    MakeEnumWords<bool>("isForwardOnly", {{false, "both"}, {true, "forward"}});

// ---- refine

/// What is subdivided: positions or differential coordinates.
inline constexpr auto kIsDifferentialWords =
    MakeEnumWords<bool>("space", {{false, "spatial"}, {true, "differential"}});

/// A rule by its name, which says the scheme, too.
struct NamedRule {
    Sdc::SchemeType scheme;
    far_ext::SubdivisionRule rule;

    bool operator==(NamedRule const&) const = default;
};
inline constexpr auto kRuleWords = MakeEnumWords<NamedRule>(
    "rule",
    {{{Sdc::SCHEME_LOOP, far_ext::SubdivisionRule::Scheme}, "loop"},
     {{Sdc::SCHEME_CATMARK, far_ext::SubdivisionRule::Scheme}, "catmark"},
     {{Sdc::SCHEME_LOOP, far_ext::SubdivisionRule::Butterfly}, "butterfly"},
     {{Sdc::SCHEME_LOOP, far_ext::SubdivisionRule::OriginalButterfly}, "butterfly-original"},
     {{Sdc::SCHEME_CATMARK, far_ext::SubdivisionRule::Kobbelt}, "kobbelt"},
     {{Sdc::SCHEME_LOOP, far_ext::SubdivisionRule::Interpolating}, "interpolating-loop"},
     {{Sdc::SCHEME_CATMARK, far_ext::SubdivisionRule::Interpolating}, "interpolating-catmark"}});

inline constexpr auto kLaplacianWords = MakeEnumWords<engine::Laplacian>(
    "laplacian", {{engine::Laplacian::Combinatorial, "combinatorial"},
                  {engine::Laplacian::Cotangent, "cotangent"},
                  {engine::Laplacian::Mesh, "mesh"}});

inline constexpr auto kDifferentialSolverWords = MakeEnumWords<engine::DifferentialSolver>(
    "solver", {{engine::DifferentialSolver::Multigrid, "multigrid"},
               {engine::DifferentialSolver::Cholesky, "cholesky"}});

// ---- smooth

inline constexpr auto kSmoothRefinementWords = MakeEnumWords<engine::SmoothRefinement>(
    "refinement", {{engine::SmoothRefinement::Quadrisect, "quadrisect"},
                   {engine::SmoothRefinement::Bisect, "bisect"}});

inline constexpr auto kCascadeSolverWords =
    MakeEnumWords<eval::CascadeSolver>("solver", {{eval::CascadeSolver::Exact, "exact"},
                                                  {eval::CascadeSolver::ConjugateGradients, "cg"},
                                                  {eval::CascadeSolver::Jacobi, "jacobi"}});

inline constexpr auto kBoundaryRuleWords = MakeEnumWords<far_ext::BoundaryRule>(
    "boundary",
    {{far_ext::BoundaryRule::Fixed, "fixed"}, {far_ext::BoundaryRule::Natural, "natural"}});

}  // namespace limn::cli
