// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/evaluate/places.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "eval/stencils/table_evaluator.h"
#include "eval/surface/surface_sample.h"

namespace limn::engine {

/// The limit at places, as arrays: one entry per place, of vectors three. NaN where the face has no
/// limit surface.
struct LimitValues {
    std::vector<double> positions, normals;
    std::vector<double> mean, gaussian, k1, k2;  ///< as eval::Curvature
    std::vector<double> directions;              ///< of k1; lines, their signs are free
    std::vector<char> hasLimit;

    /// Of so many places, none of which has a limit yet.
    static LimitValues MakeEmpty(size_t numPlaces);

    size_t CountWithoutLimit() const;
};

/// Evaluates places in double.
///
/// \throws Error  as LocatePlaces
/// \throws Stopped
LimitValues EvaluateLimit(Model const& model, PlaceArrays const& places, Orientation orientation,
                          Job& job);

/// The name of the table of places among those that an evaluator counts.
inline constexpr char const* kPlacesTable = "places";

/// The same by a table in float. Places next to irregular corners are evaluated in double all the
/// same (eval::PlaceStencils).
///
/// \throws Error  BadMesh: a position that float cannot hold
LimitValues EvaluateLimit(Model const& model, PlaceArrays const& places, Orientation orientation,
                          eval::TableEvaluator& evaluator, Job& job);

/// Samples of places as arrays. \param faces  of the places
LimitValues MakeLimitValues(eval::LimitSurface const& surface, std::span<Index const> faces,
                            std::vector<eval::SurfaceSample> const& samples);

}  // namespace limn::engine
