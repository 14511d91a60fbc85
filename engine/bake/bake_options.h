// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/images/colour_ramp.h"
#include "engine/images/exr_writer.h"
#include "engine/noise/surface_noise.h"
#include "engine/scene/model.h"

namespace limn::engine {

/// What vectors are written in.
enum class VectorSpace { Object, Tangent, UV };

/// Values are written as value * scale + offset.
struct Encoding {
    double scale = 1.0, offset = 0.0;
};

/// A 1-form on the edges of the control mesh, and the SHA-256 of what it was read from.
struct EdgeField {
    std::vector<double> values;
    std::string sha256;
};

/// What to bake. The first half is about maps: each takes what concerns it.
struct BakeOptions {
    std::vector<std::string> maps;        ///< names, as ListMapNames has them
    std::optional<Model> against;         ///< of the map displacement: the mesh it leads to
    std::optional<Model> rest;            ///< of the map tension: the mesh before it was posed
    std::optional<EdgeField> field;       ///< of the map field
    NoiseOptions noise;                   ///< of the map noise
    std::optional<ColourRamp> noiseRamp;  ///< noise as colours
    int bands = 4;                        ///< of the map bands: how many, the smooth base included
    bool isVector = false;                ///< displacement and bands as vectors
    VectorSpace space = VectorSpace::Object;
    bool isNormalized = false;  ///< noise from 0 to 1, a field of length 1
    std::optional<Encoding> encoding;

    std::string pattern;  ///< output path with {map}, {mesh}, <UDIM> or {udim}
    int width = 2048, height = 2048;
    std::vector<int> tiles;  ///< UDIM numbers; empty for all
    int samplesPerSide = 1;  ///< N x N per texel
    int padding = 16;        ///< texels
    bool isHalf = false, hasMips = false, hasCoverage = false;
    ExrCompression compression = ExrCompression::Zip;
    std::vector<std::string> groups;  ///< only faces of these; empty for all
    bool isLeftHanded = false;
    bool skipsExisting = false;
    bool hasPreview = false;
    bool wantsChecksums = false;  ///< fill BakeOutput::sha256
    std::string version;          ///< of the program, for the header
};

}  // namespace limn::engine
