// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/bake/texel_sink.h"

namespace limn::engine {

/// One output of a bake in memory, rows from the top, padded as a file would be.
struct BakedImage {
    std::string map;  ///< as BakeOutput has it
    int tile = 1001, width = 0, height = 0;
    std::vector<std::string> channels;
    std::vector<float> texels;    ///< [row][column][channel]
    std::vector<float> coverage;  ///< [row][column], 0 to 1; 0 for padding

    /// A texel's channels.
    std::span<float const> GetTexel(int row, int column) const {
        return {&texels[GetIndex(row, column) * channels.size()], channels.size()};
    }
    float GetCoverage(int row, int column) const { return coverage[GetIndex(row, column)]; }

private:
    size_t GetIndex(int row, int column) const {
        return static_cast<size_t>(row) * static_cast<size_t>(width) + static_cast<size_t>(column);
    }
};

/// Keeps a bake's images in memory.
class MemoryDestination : public BakeDestination {
public:
    std::unique_ptr<TexelSink> Open(FileLayout const& file, BakeOutput& output) override;

    /// What was committed, in that order.
    std::vector<BakedImage> TakeImages() { return std::move(_images); }

private:
    std::vector<BakedImage> _images;
};

}  // namespace limn::engine
