// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/raster/uv_raster.h"

#include <algorithm>
#include <cmath>

#include "engine/bake/raster/texture_cell.h"
#include "eval/kernels/dispatch.h"
#include "eval/surface/patch_polynomial.h"
#include "eval/surface/surface_sample.h"

namespace limn::engine {

namespace {

constexpr double kClampParameter = 1e-6;
// A face that covers a sample reaches to within kCoveredTexels of it: one that reaches farther
// round it than this is not merely a neighbour across an edge.
constexpr double kOverlapDepth = 2.0 * kCoveredTexels;
// Nearer to an edge than this, both sides of it may claim a sample, or none.
constexpr double kUndecidedDepth = 0.5 * kCoveredTexels;
// There a point beside the sample decides, in a direction that no layout has its edges in.
constexpr double kAsideX = 3.0 * kCoveredTexels, kAsideY = 1.2599 * kCoveredTexels;
constexpr int kMaxDepth = 30;  // pieces below 2^-30 of a face are linear to any precision
// So are pieces that small. Where a face stays irregular along an edge, only this ends the search
// for a sample on it: pieces multiply with depth, and all of a face that is a point are there.
constexpr double kLinearTexels = 1e-6;
// Faces that stay irregular nearly everywhere, as those with one corner twice, have more pieces
// than memory. From so many on a hundredth of a texel has to do.
constexpr size_t kManyPieces = 65536;
constexpr double kLinearTexelsOfMany = 1e-2;

/// Where the run of texels from `begin` on that lie inside and have no owner ends.
int FindEndOfHits(eval::Whereabouts const* where, Index const* owner, int begin, int end) {
    auto const isHit = [&](int i) {
        return (where[i] == eval::Whereabouts::Inside) & (owner[i] < 0);
    };
    constexpr int kGroup = 8;
    int i = begin;
    for (bool areHits = true; i + kGroup <= end; i += kGroup) {
        for (int k = 0; k < kGroup; ++k) areHits &= isHit(i + k);
        if (!areHits) break;
    }
    while (i < end && isHit(i)) ++i;
    return i;
}

}  // namespace

void TexelStrip::Resize(int first, int rows, int tileWidth) {
    firstRow = first;
    numRows = rows;
    width = tileWidth;
    size_t const count = static_cast<size_t>(rows) * tileWidth;
    owner.resize(count);
    overlap.resize(count);
    failed.resize(count);
    if (countsFaces) faceCounts.resize(count);
}

void TexelStrip::Reset(int first, int rows, int tileWidth) {
    Resize(first, rows, tileWidth);
    ClearColumns(0, tileWidth);
    overlaps.clear();
    deepestOverlap = 0.0;
}

void TexelStrip::ClearColumns(int first, int count) {
    for (int row = 0; row < numRows; ++row) {
        size_t const at = static_cast<size_t>(row) * width + first;
        std::fill_n(owner.begin() + at, count, -1);
        std::fill_n(overlap.begin() + at, count, uint8_t{0});
        std::fill_n(failed.begin() + at, count, uint8_t{0});
        if (countsFaces) std::fill_n(faceCounts.begin() + at, count, FaceCount{});
    }
}

/// In the domain of the face, not of the piece.
struct UVRaster::Surroundings {
    double s, t;
    double xs, xt, ys, yt;  // texels per s and t
    bool isTriangle, isSubQuad;

    double GetDeterminant() const { return xs * yt - xt * ys; }

    /// Texels from here to the face's nearest edge; negative outside of the face. The sides at
    /// which sub-quads of a polygon meet are no edges.
    double GetDepth() const {
        double const area = std::abs(GetDeterminant());
        double const alongS = std::hypot(xs, ys), alongT = std::hypot(xt, yt);
        double depth = std::min(s * area / alongT, t * area / alongS);
        if (isTriangle)
            depth = std::min(depth, (1.0 - s - t) * area / std::hypot(xs - xt, ys - yt));
        else if (!isSubQuad)
            depth = std::min({depth, (1.0 - s) * area / alongT, (1.0 - t) * area / alongS});
        return area > 0.0 ? depth : 0.0;
    }

    /// Whether the point (dx, dy) texels beside is the face's.
    bool HoldsBeside(double dx, double dy) const {
        double const determinant = GetDeterminant();
        if (determinant == 0.0) return false;
        double const besideS = s + (yt * dx - xt * dy) / determinant,
                     besideT = t + (xs * dy - ys * dx) / determinant;
        if (besideS < 0.0 || besideT < 0.0) return false;
        if (isTriangle) return besideS + besideT <= 1.0;
        return isSubQuad || (besideS <= 1.0 && besideT <= 1.0);
    }
};

UVRaster::UVRaster(eval::LimitSurface const& surface, std::span<double const> uvs)
    : _tree(surface, uvs, 2), _isTriangle(surface.IsLoop()) {}

UVBounds UVRaster::GetBounds(Index face) {
    _tree.Bind(face);
    double low[2], high[2];
    for (int k = 0; k < 2; ++k) {
        auto const bounds = _tree.GetBounds(0, k);
        low[k] = bounds[0];
        high[k] = bounds[1];
        if (_tree.IsLeaf(0) && !_isTriangle) {
            // Terms bounded one by one hug a bicubic piece closer than the spline's points.
            double const* const c = _tree.GetLeaf(0).coefficients + 16 * k;
            double const middle = _tree.GetOrigin(0)[k] + c[0];
            double reach =
                0x1p-46 * (std::abs(_tree.GetOrigin(0)[k]) + std::abs(c[0]));  // rounding
            for (int i = 1; i < 16; ++i)
                reach += std::abs(c[i]) * std::ldexp(1.0, -(i % 4 + i / 4));
            low[k] = std::max(low[k], middle - reach);
            high[k] = std::min(high[k], middle + reach);
        }
    }
    // Rounded outwards.
    auto const down = [](double x) { return std::nextafter(static_cast<float>(x), -1e30f); };
    auto const up = [](double x) { return std::nextafter(static_cast<float>(x), 1e30f); };
    return {down(low[0]), up(high[0]), down(low[1]), up(high[1])};
}

std::array<double, 2> UVRaster::Evaluate(int domain, double s, double t) {
    return {eval::EvaluateChannel(_tree, domain, s, t, 0),
            eval::EvaluateChannel(_tree, domain, s, t, 1)};
}

std::array<double, 4> UVRaster::GetJacobian(int domain, double s, double t) {
    auto const at = _tree.Locate(domain, s, t, kMaxDepth);
    std::array<double, 4> jacobian{};
    for (int k = 0; k < 2; ++k) {
        double const* const c = at.coefficients + k * _tree.GetNumCoefficients();
        auto const v = _isTriangle ? eval::EvaluateTrianglePolynomial(c, at.x, at.y)
                                   : eval::EvaluateQuadPolynomial(c, at.x, at.y);
        jacobian[2 * k] = v[1] * at.scale;
        jacobian[2 * k + 1] = v[2] * at.scale;
    }
    return jacobian;
}

std::vector<TexelHits> const& UVRaster::Rasterise(Index face, TileGrid const& grid,
                                                  TexelStrip& strip, int firstColumn,
                                                  int numColumns) {
    _firstColumn = firstColumn;
    _lastColumn = std::min(grid.width, firstColumn + numColumns) - 1;
    _tree.Bind(face);
    _face = face;
    _grid = grid;
    _strip = &strip;
    size_t const numDomains = static_cast<size_t>(_tree.GetNumDomains());
    if (_hits.size() < numDomains) _hits.resize(numDomains);
    for (size_t domain = 0; domain < _hits.size(); ++domain) {
        _hits[domain].Clear();
        if (domain < numDomains)
            RasterNode(_tree.GetRoot(static_cast<int>(domain)), 0, _hits[domain]);
    }
    return _hits;
}

void UVRaster::RasterNode(int node, int depth, TexelHits& hits) {
    if (_tree.IsLeaf(node)) return RasterPiece(_tree.GetLeaf(node), _tree.GetDomain(node), hits);
    // The node's points hold its limit; where no sample lies among them nothing is to be found.
    auto const u = _tree.GetBounds(node, 0), v = _tree.GetBounds(node, 1);
    double minX = _grid.ToX(u[0]), maxX = _grid.ToX(u[1]), minY = _grid.ToY(v[1]),
           maxY = _grid.ToY(v[0]);
    double const linear = _tree.GetNumNodes() < kManyPieces ? kLinearTexels : kLinearTexelsOfMany;
    bool const isLinear = depth >= kMaxDepth || (maxX - minX < linear && maxY - minY < linear);
    double const slack = 2 * kCoveredTexels;
    minX = std::max(minX - slack, static_cast<double>(_firstColumn));
    maxX = std::min(maxX + slack, static_cast<double>(_lastColumn));
    minY = std::max(minY - slack, static_cast<double>(_strip->firstRow));
    maxY = std::min(maxY + slack, _strip->firstRow + _strip->numRows - 1.0);
    if (std::ceil(minX) > std::floor(maxX) || std::ceil(minY) > std::floor(maxY)) return;
    if (isLinear) return RasterPiece(_tree.GetLinearLeaf(node), _tree.GetDomain(node), hits);
    for (int child = 0; child < 4; ++child)
        RasterNode(_tree.GetChild(node, child), depth + 1, hits);
}

void UVRaster::RasterPiece(eval::PatchPoint const& leaf, far_ext::SubDomain const& domain,
                           TexelHits& hits) {
    int const n = _tree.GetNumCoefficients();
    TexturePiece piece;
    piece.isTriangle = _isTriangle;
    piece.domain = domain;
    double const scale[2] = {static_cast<double>(_grid.width), -static_cast<double>(_grid.height)};
    for (int k = 0; k < 2; ++k) {
        for (int i = 0; i < n; ++i)
            piece.coefficients[k][i] = leaf.coefficients[k * n + i] * scale[k];
    }
    double const centreX = _grid.ToX(leaf.origin[0] + leaf.coefficients[0]);
    double const centreY = _grid.ToY(leaf.origin[1] + leaf.coefficients[n]);
    if (!(std::abs(centreX) < 1e9 && std::abs(centreY) < 1e9)) return;  // far from any tile
    piece.originX = std::floor(centreX);
    piece.originY = std::floor(centreY);
    piece.coefficients[0][0] = centreX - piece.originX;
    piece.coefficients[1][0] = centreY - piece.originY;
    piece.FindBounds();
    double const top = _strip->firstRow - 1.0, bottom = _strip->firstRow + _strip->numRows + 0.0;
    if (centreY + piece.bounds[1].reach < top || centreY - piece.bounds[1].reach > bottom ||
        centreX + piece.bounds[0].reach < _firstColumn - 1.0 ||
        centreX - piece.bounds[0].reach > _lastColumn + 1.0 || piece.IsCollapsed()) {
        return;
    }
    double worst = 0.0;
    for (int k = 0; k < 2; ++k) worst = std::max(worst, piece.GetStray(k, 0.5));
    int const numCells = std::clamp(static_cast<int>(std::ceil(std::sqrt(worst / 0.4))), 1, 256);
    double const half = 0.5 / numCells;
    for (int j = 0; j < numCells; ++j) {
        for (int i = 0; i < numCells; ++i) {
            if (_isTriangle && i + j >= numCells) continue;
            RasterCell(piece, (2 * i + 1) * half - _tree.GetCentre(),
                       (2 * j + 1) * half - _tree.GetCentre(), half, hits);
        }
    }
}

void UVRaster::RasterCell(TexturePiece const& piece, double x, double y, double half,
                          TexelHits& hits) {
    TextureCell cell(piece, x, y, half);
    _rows.clear();
    auto const [low, high] = cell.FindRows();
    int const firstRow =
        std::max(_strip->firstRow, static_cast<int>(std::ceil(std::max(low, -1.0))));
    int const lastRow = std::min(_strip->firstRow + _strip->numRows - 1,
                                 static_cast<int>(std::floor(std::min(high, 1e9))));
    int numTexels = 0;
    for (int row = firstRow; row <= lastRow; ++row) {
        auto const [from, to] = cell.FindColumns(row);
        int first =
            std::max(_firstColumn, static_cast<int>(std::ceil(std::clamp(from, -1.0, 1e9))));
        int last = std::min(_lastColumn, static_cast<int>(std::floor(std::clamp(to, -1.0, 1e9))));
        int const start = (row - _strip->firstRow) * _strip->width;
        while (first <= last && IsSettled(start + first)) ++first;
        while (first <= last && IsSettled(start + last)) --last;
        if (first > last) continue;
        _rows.push_back({row, first, last - first + 1, numTexels});
        numTexels += last - first + 1;
    }
    if (_rows.empty()) return;
    GatherTargets(piece, numTexels);
    auto const& kernel = eval::GetKernel<eval::InversionKernel>();
    kernel.fitInverse(cell.GetModel());
    kernel.invertMap(cell.GetModel(), _targetX.data(), _targetY.data(), numTexels, _x.data(),
                     _y.data(), _where.data());
    Accept(piece, hits);
}

/// Lists the texels of the rows about the piece's origin, and makes room for the answers.
void UVRaster::GatherTargets(TexturePiece const& piece, int numTexels) {
    constexpr size_t kLanes = eval::kInversionLanes;
    size_t const padded = (static_cast<size_t>(numTexels) + kLanes - 1) / kLanes * kLanes;
    if (_x.size() < padded) {
        for (auto* values : {&_targetX, &_targetY, &_x, &_y}) values->resize(padded);
        _where.resize(padded);
    }
    for (CandidateRow const& row : _rows) {
        double const x = row.column - piece.originX, y = row.row - piece.originY;
        double *const toX = &_targetX[row.first], *const toY = &_targetY[row.first];
        for (int i = 0; i < row.count; ++i) {
            toX[i] = x + i;
            toY[i] = y;
        }
    }
    for (size_t i = static_cast<size_t>(numTexels); i < padded; ++i) {
        _targetX[i] = _targetX[i - 1];
        _targetY[i] = _targetY[i - 1];
    }
}

/// Keeps the texels of the cell's rows that the face covers.
void UVRaster::Accept(TexturePiece const& piece, TexelHits& hits) {
    double const centre = _tree.GetCentre(), scale = piece.domain.scale;
    auto const placeS = [&](double s) { return piece.domain.origin[0] + scale * s; };
    auto const placeT = [&](double t) { return piece.domain.origin[1] + scale * t; };
    for (CandidateRow const& row : _rows) {
        int const texel = (row.row - _strip->firstRow) * _strip->width + row.column;
        Index* const owner = &_strip->owner[texel];
        eval::Whereabouts const* const where = &_where[row.first];
        double const *const x = &_x[row.first], *const y = &_y[row.first];
        for (int i = 0; i < row.count; ++i) {
            int const end = FindEndOfHits(where, owner, i, row.count);
            if (end > i) {
                hits.AddRun(
                    texel + i, end - i, [&](int k) { return placeS(x[i + k] + centre); },
                    [&](int k) { return placeT(y[i + k] + centre); });
                std::fill(owner + i, owner + end, _face);
                for (int k = i; _strip->countsFaces && k < end; ++k)
                    CountFace(texel + k, LookAround(piece, x[k] + centre, y[k] + centre));
                i = end;
                if (i == row.count) break;
            }
            // Outside, or found from a neighbouring cell or piece before.
            if (where[i] == eval::Whereabouts::Outside || owner[i] == _face || IsSettled(texel + i))
                continue;
            double s = x[i] + centre, t = y[i] + centre;
            size_t const target = static_cast<size_t>(row.first) + static_cast<size_t>(i);
            if (!IsCovered(piece, texel + i, where[i] != eval::Whereabouts::Unsolved,
                           _targetX[target], _targetY[target], s, t))
                continue;
            owner[i] = _face;
            hits.AddRun(
                texel + i, 1, [&](int) { return placeS(s); }, [&](int) { return placeT(t); });
        }
    }
}

/// The cases that are not plain hits: at or outside the domain's edge, claimed by another face, or
/// not converged. Clamps (s, t) to the domain; true if the texel is to be this face's.
bool UVRaster::IsCovered(TexturePiece const& piece, int texel, bool isSolved, double targetX,
                         double targetY, double& s, double& t) {
    double const centre = _tree.GetCentre();
    // The nearest place of the domain.
    double cs = std::clamp(s, 0.0, 1.0), ct = std::clamp(t, 0.0, 1.0);
    if (_isTriangle && cs + ct > 1.0) {
        double const excess = 0.5 * (cs + ct - 1.0);
        cs = std::clamp(cs - excess, 0.0, 1.0);
        ct = 1.0 - cs;
    }
    double const outside = std::max(std::abs(cs - s), std::abs(ct - t));
    if (!isSolved) {
        auto const found = SearchPiece(piece, targetX, targetY, kCoveredTexels, cs, ct);
        if (found == SearchResult::Undecided) _strip->failed[texel] = 1;
        if (found != SearchResult::Found) return false;
    } else if (outside > kClampParameter) {
        if (outside > 0.2) return false;
        // Outside; covered only if the domain's edge passes within kCoveredTexels.
        double const dx = piece.Evaluate(0, cs - centre, ct - centre)[0] - targetX;
        double const dy = piece.Evaluate(1, cs - centre, ct - centre)[0] - targetY;
        if (dx * dx + dy * dy > kCoveredTexels * kCoveredTexels) return false;
    }
    Surroundings const place = isSolved ? LookAround(piece, s, t) : LookAround(piece, cs, ct);
    if (_strip->countsFaces) CountFace(texel, place);
    if (_strip->owner[texel] >= 0) {
        double const depth = place.GetDepth();
        if (depth > kOverlapDepth) NoteOverlap(texel, depth);
        return false;
    }
    s = cs;
    t = ct;
    return true;
}

UVRaster::Surroundings UVRaster::LookAround(TexturePiece const& piece, double s, double t) const {
    double const centre = _tree.GetCentre(), scale = piece.domain.scale;
    auto const x = piece.Evaluate(0, s - centre, t - centre),
               y = piece.Evaluate(1, s - centre, t - centre);
    return {piece.domain.origin[0] + scale * s,
            piece.domain.origin[1] + scale * t,
            x[1] / scale,
            x[2] / scale,
            y[1] / scale,
            y[2] / scale,
            _isTriangle,
            _tree.GetNumDomains() > 1};
}

void UVRaster::NoteOverlap(int texel, double depth) {
    _strip->deepestOverlap = std::max(_strip->deepestOverlap, depth);
    if (_strip->overlap[texel]) return;
    _strip->overlap[texel] = 1;
    _strip->overlaps.push_back({texel, _face});
}

/// Adds the current face to those that hold a texel's sample. Of the two sides of an edge one does,
/// also where the sample lies on the edge.
void UVRaster::CountFace(int texel, Surroundings const& place) {
    TexelStrip::FaceCount& faces = _strip->faceCounts[texel];
    if (faces.last == _face) return;
    double const depth = place.GetDepth();
    bool const isHeld =
        std::abs(depth) < kUndecidedDepth ? place.HoldsBeside(kAsideX, kAsideY) : depth > 0.0;
    if (!isHeld) return;
    faces.last = _face;
    ++faces.count;
}

}  // namespace limn::engine
