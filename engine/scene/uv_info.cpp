// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/uv_info.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "engine/scene/texture_tiles.h"
#include "engine/scene/udim.h"

namespace limn::engine {

namespace {

using Polygon = std::vector<std::array<double, 2>>;

/// Marks faces whose texture polygons share samples of a 512 x 512 grid per tile. Tiles are looked
/// at one after another, so that memory holds one.
class OverlapFinder {
public:
    explicit OverlapFinder(size_t numFaces) : _overlaps(numFaces, 0) {}

    void StartTile(UdimTile tile) {
        _tile = tile;
        _owners.assign(kSize * kSize, -1);
    }

    /// Adds the part of a face's polygon that lies in the tile.
    void Add(Index face, Polygon const& polygon) {
        double minV = 1e300, maxV = -1e300;
        for (auto const& p : polygon) {
            minV = std::min(minV, p[1]);
            maxV = std::max(maxV, p[1]);
        }
        int const first = ToSample(minV - _tile.v, kOffsetV),
                  last = ToSample(maxV - _tile.v, kOffsetV) - 1;
        for (int row = first; row <= last; ++row) {
            double const v = _tile.v + (row + kOffsetV) / kSize;
            _crossings.clear();
            for (size_t i = 0; i < polygon.size(); ++i) {
                auto const& a = polygon[i];
                auto const& b = polygon[(i + 1) % polygon.size()];
                if ((a[1] <= v) != (b[1] <= v)) {
                    _crossings.push_back(a[0] + (v - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
                }
            }
            std::sort(_crossings.begin(), _crossings.end());
            for (size_t i = 0; i + 1 < _crossings.size(); i += 2) {
                int const from = ToSample(_crossings[i] - _tile.u, kOffsetU),
                          to = ToSample(_crossings[i + 1] - _tile.u, kOffsetU);
                for (int column = from; column < to; ++column) Claim(face, row, column);
            }
        }
    }

    size_t GetCount() const {
        return static_cast<size_t>(std::count(_overlaps.begin(), _overlaps.end(), 1));
    }

private:
    static constexpr int kSize = 512;
    // Samples lie on no simple fraction and on no diagonal of the texel grid, where layouts have
    // their edges.
    static constexpr double kOffsetU = 0.41421356, kOffsetV = 0.73205081;

    /// The first sample at or after a coordinate of the tile, within 0 .. kSize. Spans end before
    /// theirs, so that a sample on a shared edge belongs to one side.
    static int ToSample(double x, double offset) {
        return static_cast<int>(
            std::ceil(std::clamp(x * kSize - offset, 0.0, static_cast<double>(kSize))));
    }

    void Claim(Index face, int row, int column) {
        Index& owner = _owners[static_cast<size_t>(row * kSize + column)];
        if (owner >= 0 && owner != face)
            _overlaps[owner] = _overlaps[face] = 1;
        else
            owner = face;
    }

    UdimTile _tile;
    std::vector<Index> _owners;
    std::vector<char> _overlaps;
    std::vector<double> _crossings;
};

/// A face, and the first of its corners among the channel's value indices.
struct FaceCorners {
    Index face;
    size_t first;
};

Polygon GetTexturePolygon(Model const& model, FaceCorners const& at) {
    Index const* const values = model.GetCage().fvarChannels[0].valueIndices.data() + at.first;
    auto const& uvs = model.GetUVs();
    Polygon polygon;
    for (int i = 0; i < model.GetCage().faceSizes[at.face]; ++i)
        polygon.push_back({uvs[2 * values[i]], uvs[2 * values[i] + 1]});
    return polygon;
}

double GetSignedArea(Polygon const& polygon) {
    double area = 0.0;
    auto const& o = polygon[0];
    for (size_t i = 1; i + 1 < polygon.size(); ++i) {
        auto const &a = polygon[i], &b = polygon[i + 1];
        area += 0.5 * ((a[0] - o[0]) * (b[1] - o[1]) - (b[0] - o[0]) * (a[1] - o[1]));
    }
    return area;
}

struct Box {
    double minU = 1e300, maxU = -1e300, minV = 1e300, maxV = -1e300;

    bool IsInRange() const {
        return minU >= 0.0 && maxU <= 10.0 && minV >= 0.0 && maxV <= kMaxUdimRows;
    }
    UdimTile GetFirstTile() const { return Clamp(minU, minV); }
    UdimTile GetLastTile() const { return Clamp(maxU, maxV); }

private:
    static UdimTile Clamp(double u, double v) {
        return {std::min(9, static_cast<int>(u)), std::min(kMaxUdimRows - 1, static_cast<int>(v))};
    }
};

Box FindBox(Polygon const& polygon) {
    Box box;
    for (auto const& [u, v] : polygon) {
        box.minU = std::min(box.minU, u);
        box.maxU = std::max(box.maxU, u);
        box.minV = std::min(box.minV, v);
        box.maxV = std::max(box.maxV, v);
    }
    return box;
}

using FacesOfTile = std::map<int, std::vector<FaceCorners>>;  // by UDIM number

void AddToTiles(FaceCorners const& at, Box const& box, FacesOfTile& facesOfTile) {
    UdimTile const first = box.GetFirstTile(), last = box.GetLastTile();
    for (int v = first.v; v <= last.v; ++v) {
        for (int u = first.u; u <= last.u; ++u)
            facesOfTile[UdimTile{u, v}.GetNumber()].push_back(at);
    }
}

size_t CountOverlaps(Model const& model, FacesOfTile const& facesOfTile) {
    OverlapFinder overlaps(model.GetCage().faceSizes.size());
    for (auto const& [tile, faces] : facesOfTile) {
        overlaps.StartTile(ToUdimTile(tile));
        for (FaceCorners const& at : faces) overlaps.Add(at.face, GetTexturePolygon(model, at));
    }
    return overlaps.GetCount();
}

/// The tiles of faces with an area, and how many faces leave UDIM's range. None of a mesh whose
/// limit would take too much, which nobody can bake.
void FindTiles(Model const& model, std::vector<char> const& isFlat, UVInfo& info) {
    constexpr int kSize = 2048;  // as a bake has it that is not told otherwise
    if (eval::LimitSurface::FindExcess(model.GetRefiner())) return;
    eval::LimitSurface const surface(model.GetRefiner(), 0);
    TextureTiles tiles(surface, model.GetUVs(), kSize, kSize);
    for (Index face = 0; face < surface.GetNumFaces(); ++face) {
        if (!model.HasUVs(face) || !surface.HasLimit(face)) continue;
        info.outOfRangeFaces += tiles.IsRangeLeftBy(face);
        if (!isFlat[face]) tiles.Add(face);
    }
    info.tiles = tiles.ListNumbers();
}

}  // namespace

std::vector<char> FindFlatFaces(Model const& model) {
    constexpr double kLeastArea = 1e-12;
    std::vector<char> isFlat(model.GetCage().faceSizes.size(), 0);
    if (!model.HasUVs()) return isFlat;
    FaceCorners at{0, 0};
    for (; at.face < model.GetCage().GetNumFaces(); ++at.face) {
        double const area = GetSignedArea(GetTexturePolygon(model, at));
        isFlat[at.face] = model.HasUVs(at.face) && std::abs(area) <= kLeastArea;
        at.first += static_cast<size_t>(model.GetCage().faceSizes[at.face]);
    }
    return isFlat;
}

UVInfo DescribeUVs(Model const& model) {
    UVInfo info;
    info.present = model.HasUVs();
    if (!info.present) return info;
    auto const isFlat = FindFlatFaces(model);
    FacesOfTile facesOfTile;
    FaceCorners at{0, 0};
    for (; at.face < model.GetCage().GetNumFaces(); ++at.face) {
        auto const polygon = GetTexturePolygon(model, at);
        auto const box = FindBox(polygon);
        if (!model.HasUVs(at.face)) {
            ++info.bareFaces;
        } else if (isFlat[at.face]) {
            ++info.zeroAreaFaces;
        } else {
            info.flippedFaces += GetSignedArea(polygon) < 0.0;
            if (box.IsInRange()) AddToTiles(at, box, facesOfTile);
        }
        at.first += static_cast<size_t>(model.GetCage().faceSizes[at.face]);
    }
    if (!eval::LimitSurface::FindExcess(model.GetRefiner())) {
        FindTiles(model, isFlat, info);
    } else {  // no limit is to be had: the polygons' tiles
        for (auto const& [tile, faces] : facesOfTile) info.tiles.push_back(tile);
    }
    info.overlapFaces = CountOverlaps(model, facesOfTile);
    return info;
}

}  // namespace limn::engine
