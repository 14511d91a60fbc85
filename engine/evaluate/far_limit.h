// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/evaluate/evaluate.h"
#include "eval/stencils/stencil_evaluator.h"
#include "far_ext/limit/far_limit_stencils.h"

namespace limn::engine {

/// OpenSubdiv's limit, and what applies its table.
struct FarLimitRule {
    far_ext::FarLimitOptions options;
    eval::EvaluatorKind evaluator = eval::EvaluatorKind::OsdCpu;
};

/// The limit at places as OpenSubdiv's users get it: in float, by its patch table's limit stencils.
struct FarLimit {
    LimitValues values;
    size_t tableBytes = 0;
    double buildSeconds = 0.0;
};

/// \throws Error   as LocatePlaces and far_ext::BuildFarLimitStencils; BadMesh: a position that
///                 float cannot hold
/// \throws Stopped
FarLimit EvaluateFarLimit(Model const& model, PlaceArrays const& places, FarLimitRule const& rule,
                          Orientation orientation, Job& job);

/// How far two limits are apart at places that have both.
struct LimitDifference {
    double max = 0.0, rms = 0.0, p99 = 0.0, median = 0.0;
    size_t place = 0;  ///< of the largest
};

/// OpenSubdiv's limit against the exact one.
struct FarComparison {
    size_t numPlaces = 0;           ///< compared
    LimitDifference position;       ///< over the diagonal of the mesh's bounding box
    LimitDifference normalDegrees;  ///< angle
    LimitDifference meanCurvature;  ///< times the diagonal
};

/// \param diagonal  of the mesh's bounding box
FarComparison CompareLimits(LimitValues const& exact, LimitValues const& far, double diagonal);

/// Places of a mesh as arrays that are kept.
struct PlaceList {
    std::vector<Index> faces;
    std::vector<double> s, t;

    PlaceArrays GetPlaces() const { return {faces, s, t}; }
};

/// Appends a corner per vertex, of the first face round it that is no hole.
///
/// \return  the vertices that have one, in order
std::vector<Index> AddVertexPlaces(Model const& model, PlaceList& places);

/// Appends the middle of each face that is no hole.
void AddFaceCentres(Model const& model, PlaceList& places);

/// OpenSubdiv's limit of a mesh, and where it was compared with the exact one.
struct FarReport {
    FarLimitRule rule;
    PlaceList places;
    FarLimit far;
    FarComparison comparison;
};

/// \throws Error   as EvaluateLimit and EvaluateFarLimit
/// \throws Stopped
FarReport CompareFarLimit(Model const& model, PlaceList places, FarLimitRule const& rule,
                          Orientation orientation, Job& job);

}  // namespace limn::engine
