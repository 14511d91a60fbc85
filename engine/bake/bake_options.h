// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "engine/bake/maps/map_options.h"
#include "engine/images/exr_writer.h"

namespace limn::engine {

/// What to bake, and into what.
struct BakeOptions : MapOptions {
    std::string pattern;  ///< output path with {map}, {mesh}, <UDIM> or {udim}
    int width = 2048, height = 2048;
    std::vector<int> tiles;  ///< UDIM numbers; empty for all
    int samplesPerSide = 1;  ///< N x N per texel
    int padding = 16;        ///< texels
    bool isHalf = false, hasMips = false, hasCoverage = false;
    ExrCompression compression = ExrCompression::Zip;
    std::vector<std::string> groups;  ///< only faces of these; empty for all
    Orientation orientation = Orientation::Right;
    bool skipsExisting = false;
    bool hasPreview = false;
    bool wantsChecksums = false;  ///< fill BakeOutput::sha256
};

}  // namespace limn::engine
