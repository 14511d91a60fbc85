// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "engine/bake/maps/channel_group.h"

namespace limn::engine {

/// One row of texels of all channels, as it lies in somebody's memory: values, and how much of each
/// texel is covered (0 for padding and for nothing) and whether it holds anything at all.
struct TexelRowView {
    float const* values;  ///< channel c begins at c * stride
    size_t stride;
    float const* coverage;    ///< [width], in [0,1]
    uint8_t const* isFilled;  ///< [width]: covered or padded
};

/// A row that has memory of its own.
struct TexelRow {
    std::vector<float> values;  ///< [channel][width]
    std::vector<float> coverage;
    std::vector<uint8_t> isFilled;

    TexelRowView GetView() const {
        return {values.data(), coverage.size(), coverage.data(), isFilled.data()};
    }
};

/// Makes mip levels row by row, so that memory holds a few rows of each level and never an image.
///
/// Each texel is the mean of what its box holds, weighted by area and coverage; where nothing is
/// covered, of the padding. Sizes are ROUND_DOWN: a box is 2 wide, or 2 + 1/w' where the finer size
/// is odd. Unit vectors are normalised again, lines averaged as d d^T; of counts the
/// largest is taken.
class MipChain {
public:
    /// \param emit  called for every finished row of a level >= 1, from fine to coarse
    using Emit = std::function<void(int level, int row, TexelRowView const& texels)>;

    MipChain(int width, int height, int numLevels, int numChannels,
             std::vector<ChannelGroup> groups, Emit emit);

    /// Rows of level 0, from the top, as many at a time as there are. They are not looked at later.
    void Add(std::span<TexelRowView const> rows);

private:
    struct Level {
        int width = 0, height = 0;
        int numRows = 0;                       // rows received so far
        std::array<TexelRowView, 3> window{};  // the last three of them, by row % 3
        std::array<TexelRow, 3> kept;          // their memory, where it is ours
    };

    void AddRow(int level, TexelRowView const& row);
    void Keep(Level& level, int row);
    void Reduce(Level const& from, int row, int width, int height, TexelRow& result) const;
    void ReduceQuarters(TexelRowView const& top, TexelRowView const& bottom,
                        TexelRow& result) const;
    void ReduceBox(Level const& from, struct Box const& rows, struct Box const& columns, int x,
                   TexelRow& result) const;
    void AverageTexel(std::span<float const> weights, std::span<float const* const> values,
                      std::span<size_t const> strides, float* out, size_t outStride) const;

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
