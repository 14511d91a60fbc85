// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include "engine/bake/maps/maps.h"
#include "engine/images/exr_writer.h"
#include "engine/noise/surface_noise.h"
#include "engine/scene/job.h"
#include "engine/scene/scene.h"

namespace limn::engine {

struct BakeOptions {
    std::string pattern;  ///< output path with {map}, {mesh}, <UDIM> or {udim}
    MapOptions maps;
    NoiseOptions noise;         ///< of the map 'noise'
    std::vector<double> field;  ///< of the map 'field': a 1-form, per edge of the control mesh
    std::string fieldHash;      ///< SHA-256 of what it was read from
    int width = 2048, height = 2048;
    std::vector<int> tiles;  ///< UDIM numbers; empty for all
    int samplesPerSide = 1;  ///< N x N per texel
    int padding = 16;        ///< texels
    bool isHalf = false, hasMips = false, hasCoverage = false;
    ExrCompression compression = ExrCompression::Zip;
    std::vector<std::string> groups;  ///< only faces of these; empty for all
    bool isLeftHanded = false;
    bool skipExisting = false;
    bool hasPreview = false;
    bool wantsChecksums = false;  ///< fill BakeOutput::sha256
    std::string version;          ///< of the program, for the header
};

/// One finished file.
struct BakeOutput {
    std::string path, map, sha256;
    int tile = 1001, width = 0, height = 0;
    bool wasSkipped = false;
    float min = 0.0f, max = 0.0f;  ///< over covered texels, all channels
    std::vector<Map> maps;
};

struct BakeReport {
    size_t texelsCovered = 0, overlaps = 0, newtonFailures = 0, movedSamples = 0,
           degenerateSamples = 0, clamped = 0;
    std::vector<int> tiles;
    std::vector<BakeOutput> outputs;
    std::vector<Index> facesWithoutTexels;  ///< of those selected
};

/// Bakes maps of a mesh's limit surface to UDIM tiles. Files appear one by one as they are
/// complete; on an error or an interrupt those already complete stay.
///
/// Memory   a few bands of 64 rows per thread, whatever the size of the image.
/// Threads  TBB's current arena; results do not depend on it.
///
/// \param scene    validated, with UVs
/// \param refiner  the scene's own, unrefined
/// \param other    for displacement: a mesh of the same faces; may be null
/// \throws Error BadMesh: no UVs, or nothing to bake. BadOption. Io. Interrupted where a signal
///               came
BakeReport Bake(Scene const& scene, Far::TopologyRefiner const& refiner, Scene const* other,
                BakeOptions const& options, Job& job);

/// `pattern` with its tokens replaced. \param map  may be empty where the pattern has no {map}
std::string ExpandPattern(std::string const& pattern, std::string const& map,
                          std::string const& mesh, int tile);

}  // namespace limn::engine
