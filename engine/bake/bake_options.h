// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/bake/maps/map_options.h"
#include "engine/bake/maps/preview_range.h"
#include "engine/images/exr_writer.h"

namespace limn::engine {

struct BakeOutput;

/// What to bake, and into what.
struct BakeOptions : MapOptions {
    std::string pattern;  ///< output path with tokens, see output_names.h
    std::string group;    ///< what {group} stands for, see SplitByGroup
    int width = 2048, height = 2048;
    std::vector<int> tiles;             ///< UDIM numbers; empty for all
    int samplesPerSide = 1;             ///< N x N per texel
    int padding = 16;                   ///< texels
    bool isHalf = false;                ///< 16-bit floats ...
    std::vector<std::string> halfMaps;  ///< ... of these maps; empty for all
    bool hasMips = false, hasCoverage = false;
    ExrCompression compression = ExrCompression::Zip;
    std::vector<std::string> groups;  ///< only faces of these; empty for all
    Orientation orientation = Orientation::Right;
    bool mayBeEmpty = false;  ///< no texel at all is a warning
    bool skipsExisting = false;
    bool countsSkipped = false;  ///< BakeReport counts texels of skipped files, too, for audits
    bool hasPreview = false, hasPreviewLegend = false;  ///< pictures beside the files
    std::optional<PreviewRange> previewRange;           ///< none: what suits each map
    bool wantsChecksums = false;                        ///< fill BakeOutput::sha256

    /// Whether a map is written with 16 bits.
    bool IsHalf(std::string const& map) const {
        return isHalf && (halfMaps.empty() || std::ranges::find(halfMaps, map) != halfMaps.end());
    }

    /// Told of each output as it is complete, on one thread at a time: what a bake that fails
    /// later leaves.
    std::function<void(BakeOutput const&)> onOutput{};
};

}  // namespace limn::engine
