// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/fit/band_sum.h"
#include "engine/images/colour_ramp.h"
#include "engine/noise/surface_noise.h"
#include "engine/scene/model.h"

namespace limn::engine {

/// What vectors are written in.
enum class VectorSpace { Object, Tangent, UV };

/// Values are written as value * scale + offset.
struct Encoding {
    double scale = 1.0, offset = 0.0;
};

/// FindOrigin's, of the mesh that is baked.
struct AutomaticOrigin {};
using Origin = std::variant<AutomaticOrigin, std::array<double, 3>>;

/// Which maps, and what they are made of: each takes what concerns it.
struct MapOptions {
    std::vector<std::string> maps;             ///< names, as ListMapNames has them
    std::optional<Model> against;              ///< of the map displacement: the mesh it leads to
    std::optional<Model> rest;                 ///< of the map tension: the mesh before it was posed
    std::optional<Origin> origin;              ///< of the map position: taken off it
    std::optional<std::vector<double>> field;  ///< of the map field: a 1-form on the mesh's edges
    NoiseOptions noise;                        ///< of the map noise
    std::optional<ColourRamp> noiseRamp;       ///< noise as colours
    int bands = 4;  ///< of the map bands: how many, the smooth base included
    std::optional<BandSumOptions> bandSum;  ///< of the map bands: one layer, the way to this sum
    bool isVector = false;                  ///< displacement and bands as vectors
    VectorSpace space = VectorSpace::Object;
    bool isNormalized = false;  ///< noise from 0 to 1, a field of length 1
    std::optional<Encoding> encoding;
    /// Applies the tables of the maps noise, field and bands, in float; null: in double.
    eval::TableEvaluator* evaluator = nullptr;

    /// What an evaluator adds to the text that tells of a map's options.
    std::string DescribeEvaluator() const {
        if (!evaluator) return {};
        return std::string(" evaluator=") + eval::GetName(evaluator->GetKind());
    }
};

}  // namespace limn::engine
