// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/scene/udim.h"
#include "eval/surface/face_tree.h"
#include "eval/surface/polynomial_bounds.h"

namespace limn::engine {

/// Bounds of a face's texture coordinates: those of its control points, which hold the limit.
struct UVBounds {
    float minU, maxU, minV, maxV;
};

/// The UDIM tiles that faces reach into, by the limit of their texture coordinates. What reaches
/// over a border by less than half a texel reaches no sample, and does not count.
///
/// Search   squares of a face's domain are quartered until their bounds lie in one tile, in tiles
///          that are known already, or in none. Pieces of such numbers that doubles cannot tell
///          tiles apart reach none.
class TextureTiles {
public:
    /// \param surface        of the texture coordinates; kept by reference, as are these
    /// \param width, height  samples of a tile
    TextureTiles(eval::LimitSurface const& surface, std::span<double const> uvs, int width,
                 int height);

    /// Adds the tiles of a face that has a limit.
    void Add(Index face);

    /// True if all tiles within bounds are there already.
    bool HoldsAll(UVBounds const& bounds) const;

    /// True if the face reaches into a tile that has not been added.
    bool IsLeftBy(Index face);

    /// True if some place of the face lies outside of UDIM's range, by more than rounding.
    bool IsRangeLeftBy(Index face);

    void AddTile(UdimTile tile) { _columnsOfRow[tile.v] |= static_cast<uint16_t>(1u << tile.u); }
    size_t GetCount() const;
    std::vector<int> ListNumbers() const;  ///< in order

private:
    struct Box;
    struct Range;
    struct Piece;
    enum class Verdict { Nothing, Unclear, Found };

    Range FindTiles(Box const& box) const;
    bool HoldsAll(Range const& tiles) const;
    Verdict Judge(Box const& box, Range const& tiles, bool isLast) const;
    bool IsLast(Box const& box, int depth) const;
    template <class Ask>
    bool Search(Index face, Ask ask);
    template <class Ask>
    bool SearchNode(int node, int depth, Ask& ask);
    template <class Ask>
    bool SearchPiece(Piece const& piece, double x, double y, double half, int depth, Ask& ask);

    eval::FaceTree _tree;
    bool _isTriangle;
    double _marginU, _marginV;                           // of a tile, where no samples are
    std::array<uint16_t, kMaxUdimRows> _columnsOfRow{};  // a bit per tile that is there
};

}  // namespace limn::engine
