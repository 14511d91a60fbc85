// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "engine/bake/raster/texture_piece.h"
#include "eval/surface/inversion_kernel.h"

namespace limn::engine {

/// A texel this near to a face is covered by it [Bake 1].
inline constexpr double kCoveredTexels = 1e-4;

/// A square of a texture piece on which the map is nearly linear: which texels may lie in it, and
/// what eval::InversionKernel needs to know to say which do. Texels are those of the tile.
class TextureCell {
public:
    /// \param x, y  the square's centre, about the piece's; \param half  half of its width
    TextureCell(TexturePiece const& piece, double x, double y, double half);

    /// Bounds of the rows, and of the columns [first, last] of one row, whose texels may lie in the
    /// cell; last < first where there are none.
    std::array<double, 2> FindRows() const { return {_middleY - _reachY, _middleY + _reachY}; }
    std::array<double, 2> FindColumns(int row) const;

    eval::InversionCell& GetModel() { return _model; }

private:
    /// Where |slope * dx + perRow * dy| <= limit: |dx - shift * dy| <= width. Without a slope:
    /// 1e300.
    struct Slab {
        double width = 1e300, shift = 0.0;
        bool isFlat = false;  // no slope: a bound on dy alone
        double perRow = 0.0, limit = 0.0;
        Slab() = default;
        Slab(double slope, double perRow, double limit);
    };

    eval::InversionCell _model;
    double _middleX, _middleY, _reachX, _reachY;
    Slab _slabs[2];
};

}  // namespace limn::engine
