// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/raster/texture_cell.h"

#include <algorithm>
#include <cmath>

namespace limn::engine {

TextureCell::Slab::Slab(double slope, double ofRow, double most) : perRow(ofRow), limit(most) {
    isFlat = std::abs(slope) < 1e-12;
    if (isFlat) return;
    width = most / std::abs(slope);
    shift = -ofRow / slope;
}

TextureCell::TextureCell(TexturePiece const& piece, double x, double y, double half) {
    auto const [u, us, ut] = piece.Evaluate(0, x, y);
    auto const [v, vs, vt] = piece.Evaluate(1, x, y);
    double const det = us * vt - ut * vs, size = us * us + ut * ut + vs * vs + vt * vt;
    bool const isInvertible = std::abs(det) > 1e-9 * size;
    double const toInverse = isInvertible ? 1.0 / det : 0.0;
    std::array<double, 4> const inverse{vt * toInverse, -ut * toInverse, -vs * toInverse,
                                        us * toInverse};
    // How far the map strays from its linear part within the cell, plus what counts as covered.
    double const strayX = piece.GetStray(0, half) + 10 * kCoveredTexels;
    double const strayY = piece.GetStray(1, half) + 10 * kCoveredTexels;
    _middleX = piece.originX + u;
    _middleY = piece.originY + v;
    _reachX = (std::abs(us) + std::abs(ut)) * half + strayX;
    _reachY = (std::abs(vs) + std::abs(vt)) * half + strayY;

    double reach = half, bend = 1e300, outside = 0.2;
    if (isInvertible) {
        // d(x,y) = inverse * d(u,v) must stay within the cell, give or take the stray.
        double const limitX = half + strayX * std::abs(inverse[0]) + strayY * std::abs(inverse[1]);
        double const limitY = half + strayX * std::abs(inverse[2]) + strayY * std::abs(inverse[3]);
        _slabs[0] = Slab(inverse[0], inverse[1], limitX);
        _slabs[1] = Slab(inverse[2], inverse[3], limitY);
        reach = std::min(std::max(limitX, limitY), 2.0 * half);
        double const second = 2.0 * std::hypot(piece.GetStray(0, 1.0), piece.GetStray(1, 1.0));
        bend = second * size / (det * det);  // |inverse|^2 <= size / det^2
        // The map's Jacobian keeps half of its size within `reach`: so far outside, in parameters,
        // a texel is more than covering's distance away.
        double const inverseNorm = std::sqrt(size) / std::abs(det);
        if (second * reach * inverseNorm < 0.5)
            outside = std::max(4.0 * kCoveredTexels * inverseNorm, 1e-6);
    }
    _model = {.coefficients = &piece.coefficients[0][0],
              .isTriangle = piece.isTriangle,
              .x = x,
              .y = y,
              .value = {u, v},
              .inverse = {inverse[0], inverse[1], inverse[2], inverse[3]},
              .area = std::abs(det) * 4.0 * half * half,
              .reach = reach,
              .bend = bend,
              .centre = piece.GetCentre(),
              .outside = outside,
              .tolerance = kCoveredTexels,
              .guess = {}};
}

std::array<double, 2> TextureCell::FindColumns(int row) const {
    double const dy = row - _middleY;
    double from = -_reachX, to = _reachX;
    for (Slab const& slab : _slabs) {
        if (slab.isFlat && std::abs(slab.perRow * dy) > slab.limit) return {0.0, -1.0};
        from = std::max(from, slab.shift * dy - slab.width);
        to = std::min(to, slab.shift * dy + slab.width);
    }
    return {_middleX + from, _middleX + to};
}

}  // namespace limn::engine
