// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/evaluate/places.h"
#include "engine/images/colour_ramp.h"
#include "engine/noise/surface_noise.h"
#include "engine/scene/job.h"

namespace limn::engine {

/// A number per place, NaN where the face has no limit surface.
struct PlaceColumn {
    std::string name;
    std::vector<double> values;
};

/// Maps of a bake that are evaluated at places: by the same numbers as there.
struct PlaceMapOptions {
    /// "noise": the column noise or, through a ramp, noise_r, noise_g, noise_b; "field": fx, fy,
    /// fz; "primvar:NAME": NAME or, of several channels, NAME_r and so on.
    std::vector<std::string> maps;
    NoiseOptions noise{};
    std::optional<ColourRamp> noiseRamp{};
    std::optional<std::vector<double>> field{};  ///< a 1-form on the mesh's edges
    bool isNormalized = false;                   ///< noise from 0 to 1, a field of length 1
};

struct PlaceColumns {
    std::vector<PlaceColumn> columns;  ///< map after map
    std::vector<int> singularLevels;   ///< of noise, as SurfaceNoise's
};

/// \throws Error  BadOption: another map, one twice, a primvar that the mesh has not, a field
/// without
///                a form; as LocatePlaces, SurfaceNoise and eval::FieldSurface
/// \throws Stopped
PlaceColumns EvaluateMaps(Model const& model, PlaceArrays const& places,
                          PlaceMapOptions const& options, Job& job);

}  // namespace limn::engine
