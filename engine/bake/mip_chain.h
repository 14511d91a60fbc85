#pragma once

#include <functional>
#include <span>
#include <vector>

#include "engine/bake/maps.h"

namespace limn::engine {

/// How a run of channels is averaged.
struct ChannelGroup {
    int first = 0, count = 1;
    Averaging averaging = Averaging::Plain;
};

/// One row of texels of all channels: values, and how much of each texel is covered (0 for padding
/// and for nothing) and whether it holds anything at all.
struct TexelRow {
    std::vector<float> values;    ///< [channel][width]
    std::vector<float> coverage;  ///< [width], in [0,1]
    std::vector<uint8_t> isFilled;  ///< [width]: covered or padded
};

/// Makes mip levels row by row, so that memory holds a few rows of each level and never an image.
///
/// Each texel is the mean of what its box holds, weighted by area and coverage; where nothing is
/// covered, of the padding. Sizes are ROUND_DOWN: a box is 2 wide, or 2 + 1/w' where the finer size
/// is odd. Unit vectors are normalised again, lines averaged as d d^T.
class MipChain {
public:
    /// \param emit  called for every finished row of a level >= 1, from fine to coarse
    using Emit = std::function<void(int level, int row, TexelRow const& texels)>;

    MipChain(int width, int height, int numLevels, int numChannels, std::vector<ChannelGroup> groups, Emit emit);

    /// Rows of level 0, from the top.
    void Add(TexelRow const& row) { AddRow(0, row); }

private:
    struct Level {
        int width = 0, height = 0;
        int numRows = 0;               // rows received so far
        std::vector<TexelRow> window;  // the last three of them, by row % 3
    };

    void AddRow(int level, TexelRow const& row);
    TexelRow Reduce(Level const& from, int width, int height, int row) const;
    bool ReduceQuarter(Level const& from, int row, int x, TexelRow& result) const;
    void AverageTexel(std::span<float const> weights, std::span<float const* const> values,
                      std::span<size_t const> at, size_t stride, float* out, size_t outStride) const;

    int _numChannels;
    std::vector<ChannelGroup> _groups;
    bool _hasLines = false;
    Emit _emit;
    std::vector<Level> _levels;
};

/// The unit vector d whose line d d^T is nearest to the sum of weighted d d^T of the lines given
/// (xx, xy, xz, yy, yz, zz): its main eigenvector. Zero if there is none.
std::array<float, 3> FindMainLine(std::array<double, 6> const& sum);

}  // namespace limn::engine
