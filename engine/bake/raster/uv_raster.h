// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/bake/raster/texture_piece.h"
#include "engine/scene/texture_tiles.h"
#include "engine/scene/udim.h"
#include "eval/surface/face_tree.h"
#include "eval/surface/inversion_kernel.h"
#include "far_ext/rows/large_array.h"

namespace limn::engine {

/// Where the samples of one texture tile lie [Bake 1]. The sample of texel (x, y), y = 0 at the
/// top, is at
///     u = tileU + (x + offsetX) / width,   v = tileV + 1 - (y + offsetY) / height.
struct TileGrid {
    int width = 0, height = 0;
    int tileU = 0, tileV = 0;
    double offsetX = 0.5, offsetY = 0.5;

    /// Texel centres of a UDIM tile.
    static TileGrid OfTile(int number, int width, int height) {
        UdimTile const tile = ToUdimTile(number);
        return {width, height, tile.u, tile.v};
    }

    /// Texel coordinates of (u, v): whole numbers at the samples.
    double ToX(double u) const { return (u - tileU) * width - offsetX; }
    double ToY(double v) const { return (tileV + 1 - v) * height - offsetY; }
};

/// Rows [firstRow, firstRow + numRows) of a tile: who covers which texel.
struct TexelStrip {
    /// A texel found to be covered twice: by its owner, and by the lowest face after that.
    struct Overlap {
        int texel;
        Index other;
    };
    /// How many faces hold a texel's sample, each side of a shared edge for itself; `last` is the
    /// latest of them.
    struct FaceCount {
        Index last = -1;
        int count = 0;
    };

    int firstRow = 0, numRows = 0, width = 0;
    std::vector<Index> owner;      ///< per texel: the lowest face that covers it, or -1
    std::vector<uint8_t> overlap;  ///< not 0 where another face covers it, too
    std::vector<uint8_t> failed;   ///< 1 where a search came to no end

    std::vector<Overlap> overlaps;  ///< one for each texel that overlaps, as they were found
    double deepestOverlap = 0.0;    ///< how far, in texels, the second face reaches round a sample

    bool countsFaces = false;  ///< takes its time: no texel is settled before the last face
    std::vector<FaceCount> faceCounts;  ///< per texel; empty unless faces are counted

    void Resize(int first, int rows, int tileWidth);  ///< texels keep what they held
    void Reset(int first, int rows, int tileWidth);   ///< no texel is covered
    void ClearColumns(int first, int count);          ///< no texel of these is covered

    /// The faces over a texel's sample, 0 where it is not covered. \pre countsFaces
    int CountFaces(size_t texel) const {
        return owner[texel] < 0 ? 0 : std::max(1, faceCounts[texel].count);
    }
};

/// A texel covered by a face, and where on it.
struct TexelHits {
    far_ext::LargeArray<int> texel;  ///< index into the strip
    far_ext::LargeArray<double> s, t;

    /// Adds `count` texels side by side, at places (placeS(i), placeT(i)).
    template <class S, class T>
    void AddRun(int first, int count, S placeS, T placeT) {
        size_t const at = texel.size(), end = at + static_cast<size_t>(count);
        texel.resize(end);
        s.resize(end);
        t.resize(end);
        for (int i = 0; i < count; ++i) {
            texel[at + i] = first + i;
            s[at + i] = placeS(i);
            t[at + i] = placeT(i);
        }
    }
    void Clear() {
        texel.clear();
        s.clear();
        t.clear();
    }
};

/// Inverts the texture map, itself a subdivision surface: which texels does a face cover, and where
/// on the face do they lie?
///
/// Search   the map's polynomial pieces are cut into cells on which it deviates from linear by less
///          than half a texel; the linear map of a cell, grown by that deviation, gives candidates
///          row by row, and eval::InversionKernel finds where they lie on the exact map.
/// Threads  one per thread
class UVRaster {
public:
    /// \param surface  face-varying limit surface; \param uvs 2 per value; both kept by reference
    UVRaster(eval::LimitSurface const& surface, std::span<double const> uvs);

    /// The texels of the strip that `face` covers and no face before it does, one TexelHits per
    /// domain. Faces must come in ascending order.
    ///
    /// \param firstColumn, numColumns  the part of the strip that is looked at
    std::vector<TexelHits> const& Rasterise(Index face, TileGrid const& grid, TexelStrip& strip,
                                            int firstColumn, int numColumns);
    std::vector<TexelHits> const& Rasterise(Index face, TileGrid const& grid, TexelStrip& strip) {
        return Rasterise(face, grid, strip, 0, grid.width);
    }

    UVBounds GetBounds(Index face);

    /// Makes `face` the one the functions below speak of; Rasterise and GetBounds do so too.
    void Bind(Index face) { _tree.Bind(face); }

    /// (u, v) at a place, and d(u,v)/d(s,t) there: us, ut, vs, vt.
    std::array<double, 2> Evaluate(int domain, double s, double t);
    std::array<double, 4> GetJacobian(int domain, double s, double t);

private:
    void RasterNode(int node, int depth, TexelHits& hits);
    void RasterPiece(eval::PatchPoint const& leaf, far_ext::SubDomain const& domain,
                     TexelHits& hits);
    void RasterCell(TexturePiece const& piece, double x, double y, double half, TexelHits& hits);
    /// True if nothing is left to learn of a texel from the current face: it is known to be covered
    /// twice, or to be covered by this face.
    bool IsSettled(int texel) const {
        if (_strip->countsFaces && _strip->faceCounts[texel].last != _face) return false;
        return _strip->overlap[texel] && _strip->owner[texel] >= 0;
    }
    void GatherTargets(TexturePiece const& piece, int numTexels);
    void Accept(TexturePiece const& piece, TexelHits& hits);
    bool IsCovered(TexturePiece const& piece, int texel, bool isSolved, double targetX,
                   double targetY, double& s, double& t);
    /// A place of the current face, and how texels change there with (s, t) of its domain.
    struct Surroundings;
    Surroundings LookAround(TexturePiece const& piece, double s, double t) const;
    void NoteOverlap(int texel, double depth);
    void CountFace(int texel, Surroundings const& place);

    eval::FaceTree _tree;
    bool _isTriangle;
    std::vector<TexelHits> _hits;
    // the call at hand
    Index _face = -1;
    TileGrid _grid;
    TexelStrip* _strip = nullptr;
    int _firstColumn = 0, _lastColumn = 0;
    // candidates of the cell at hand, row by row, and the answers for them
    struct CandidateRow {
        int row, column, count;
        int first;  // into the arrays below
    };
    std::vector<CandidateRow> _rows;
    std::vector<double> _targetX, _targetY, _x, _y;
    std::vector<eval::Whereabouts> _where;
};

}  // namespace limn::engine
