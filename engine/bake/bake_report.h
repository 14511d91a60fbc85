// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/bake/layout.h"

namespace limn::engine {

/// One finished file, or image in memory.
struct BakeOutput {
    std::string path;                   ///< empty in memory
    std::vector<std::string> previews;  ///< beside it
    std::string map;                    ///< "mean", or "mean+normal" where maps share a file
    std::string sha256;                 ///< empty where none was asked for, or nothing can be read
    int tile = 1001, width = 0, height = 0;
    bool wasSkipped = false;
    std::optional<std::array<double, 3>> origin;  ///< taken off positions, where asked for
    bool isAlongNormal = false;                   ///< displacements are written along the normal
    TangentialPart leftOut;                       ///< of them, where samples were looked at
    float min = 0.0f, max = 0.0f;                 ///< over covered texels, all channels
};

/// Texels over which several faces lie.
struct OverlapReport {
    std::array<Index, 2> faces{-1, -1};     ///< the lowest pair
    double depth = 0.0;                     ///< how far, in texels, they reach round a sample
    std::array<size_t, 3> betweenGroups{};  ///< by GroupKind: texels of faces of different groups
};

struct BakeReport {
    size_t texelsCovered = 0;
    size_t overlaps = 0;  ///< texels under several faces
    size_t newtonFailures = 0, movedSamples = 0, degenerateSamples = 0, clamped = 0;
    OverlapReport overlap;  ///< what lies over those texels
    std::vector<int> tiles;
    std::vector<BakeOutput> outputs;
    std::vector<FileLayout> files;          ///< what outputs of each name hold
    std::vector<Index> facesWithoutTexels;  ///< of those selected
    std::vector<int> singularNoiseLevels;   ///< as SurfaceNoise's
};

}  // namespace limn::engine
