// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/bake/layout.h"

namespace limn::engine {

/// One finished file, or image in memory.
struct BakeOutput {
    std::string path;  ///< empty in memory
    std::string map;   ///< "mean", or "mean+normal" where maps share a file
    std::string sha256;
    int tile = 1001, width = 0, height = 0;
    bool wasSkipped = false;
    float min = 0.0f, max = 0.0f;  ///< over covered texels, all channels
};

struct BakeReport {
    size_t texelsCovered = 0, overlaps = 0, newtonFailures = 0, movedSamples = 0,
           degenerateSamples = 0, clamped = 0;
    std::vector<int> tiles;
    std::vector<BakeOutput> outputs;
    std::vector<FileLayout> files;          ///< what outputs of each name hold
    std::vector<Index> facesWithoutTexels;  ///< of those selected
};

}  // namespace limn::engine
