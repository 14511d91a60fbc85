// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/bake/strip_baker.h"

namespace limn::engine {

/// A band ready to be written: the finished tiles of each file, and its rows where something (mips,
/// a preview) goes on from them.
struct PackedBand {
    struct File {
        std::vector<ExrTile> tiles;
        std::vector<TexelRowView> rows;
        float min = 0.0f, max = 0.0f;  ///< over covered texels; min > max if there are none
    };
    int index = 0;
    std::vector<File> files;
    std::shared_ptr<Band> band;   ///< what the rows look at, and
    std::vector<float> coverage;  ///< [row][column]; empty where nobody asks for it
};

/// Pads a band from its neighbours and packs it for each file.
///
/// \param window   the band and those round it, in order, at least enough for the padding where
///                 they exist
/// \param at       the band's place in the window. Only its uncovered texels are written, so that
///                 neighbours may be padded from it at the same time
/// \param writers  one per file; null for files that are not written
/// \param needsRows  per file
PackedBand PackBand(std::span<std::shared_ptr<Band> const> window, size_t at, int padding,
                    std::vector<FileLayout> const& files,
                    std::vector<std::unique_ptr<ExrWriter>> const& writers, bool hasCoverage,
                    bool needsRows);

}  // namespace limn::engine
