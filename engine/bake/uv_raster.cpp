#include "engine/bake/uv_raster.h"

#include <algorithm>
#include <cmath>

#include "eval/patch_polynomial.h"
#include "eval/surface_kernel.h"
#include "eval/surface_sample.h"

namespace limn::engine {

namespace {

constexpr double kCoveredTexels = 1e-4;  // a texel this near to a face is covered (bake.md)
constexpr double kClampParameter = 1e-6;
constexpr double kOverlapParameter = 1e-3;  // nearer to an edge two faces may well share a texel
constexpr int kMaxNewtonSteps = 12;
constexpr int kMaxDepth = 30;       // pieces below 2^-30 of a face are linear to any precision
constexpr size_t kFlushAt = 1024;   // candidates per Newton batch

/// Bound of how fast the map's Jacobian changes from texel to texel, where it is u[1..2], v[1..2].
double FindBend(TexturePiece const& piece, std::array<double, 3> const& u, std::array<double, 3> const& v) {
    double const det = u[1] * v[2] - u[2] * v[1];
    double const size = u[1] * u[1] + u[2] * u[2] + v[1] * v[1] + v[2] * v[2];
    double const second = 2.0 * std::hypot(piece.GetStray(0, 1.0), piece.GetStray(1, 1.0));
    return det == 0.0 ? 1e300 : second * size / (det * det);  // |inverse|^2 <= size / det^2
}

}  // namespace

void TexelBand::Reset(int first, int rows, int tileWidth) {
    firstRow = first;
    numRows = rows;
    width = tileWidth;
    size_t const count = static_cast<size_t>(rows) * tileWidth;
    owner.assign(count, -1);
    overlap.assign(count, 0);
    failed.assign(count, 0);
}

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
            double reach = 0.0;
            for (int i = 1; i < 16; ++i) reach += std::abs(c[i]) * std::ldexp(1.0, -(i % 4 + i / 4));
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
    return {eval::EvaluateChannel(_tree, domain, s, t, 0), eval::EvaluateChannel(_tree, domain, s, t, 1)};
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

std::vector<TexelHits> const& UVRaster::Rasterise(Index face, TileGrid const& grid, TexelBand& band, int firstColumn,
                                                  int numColumns) {
    _firstColumn = firstColumn;
    _lastColumn = std::min(grid.width, firstColumn + numColumns) - 1;
    _tree.Bind(face);
    _face = face;
    _grid = grid;
    _band = &band;
    size_t const numDomains = static_cast<size_t>(_tree.GetNumDomains());
    if (_hits.size() < numDomains) _hits.resize(numDomains);
    for (size_t domain = 0; domain < _hits.size(); ++domain) {
        _hits[domain].Clear();
        if (domain < numDomains) RasterNode(_tree.GetRoot(static_cast<int>(domain)), 0, _hits[domain]);
    }
    return _hits;
}

void UVRaster::RasterNode(int node, int depth, TexelHits& hits) {
    if (_tree.IsLeaf(node)) return RasterPiece(_tree.GetLeaf(node), _tree.GetDomain(node), hits);
    // The node's points hold its limit; where no sample lies among them nothing is to be found.
    auto const u = _tree.GetBounds(node, 0), v = _tree.GetBounds(node, 1);
    double minX = _grid.ToX(u[0]), maxX = _grid.ToX(u[1]), minY = _grid.ToY(v[1]), maxY = _grid.ToY(v[0]);
    double const slack = 2 * kCoveredTexels;
    minX = std::max(minX - slack, static_cast<double>(_firstColumn));
    maxX = std::min(maxX + slack, static_cast<double>(_lastColumn));
    minY = std::max(minY - slack, static_cast<double>(_band->firstRow));
    maxY = std::min(maxY + slack, _band->firstRow + _band->numRows - 1.0);
    if (std::ceil(minX) > std::floor(maxX) || std::ceil(minY) > std::floor(maxY)) return;
    if (depth >= kMaxDepth) return RasterPiece(_tree.GetLinearLeaf(node), _tree.GetDomain(node), hits);
    for (int child = 0; child < 4; ++child) RasterNode(_tree.GetChild(node, child), depth + 1, hits);
}

void UVRaster::RasterPiece(eval::PatchPoint const& leaf, far_ext::SubDomain const& domain, TexelHits& hits) {
    int const n = _tree.GetNumCoefficients();
    TexturePiece piece;
    piece.isTriangle = _isTriangle;
    piece.domain = domain;
    double const scale[2] = {static_cast<double>(_grid.width), -static_cast<double>(_grid.height)};
    for (int k = 0; k < 2; ++k) {
        for (int i = 0; i < n; ++i) piece.coefficients[k][i] = leaf.coefficients[k * n + i] * scale[k];
    }
    double const centreX = _grid.ToX(leaf.origin[0] + leaf.coefficients[0]);
    double const centreY = _grid.ToY(leaf.origin[1] + leaf.coefficients[n]);
    if (!(std::abs(centreX) < 1e9 && std::abs(centreY) < 1e9)) return;  // far from any tile
    piece.originX = std::floor(centreX);
    piece.originY = std::floor(centreY);
    piece.coefficients[0][0] = centreX - piece.originX;
    piece.coefficients[1][0] = centreY - piece.originY;
    piece.FindBounds();
    double const top = _band->firstRow - 1.0, bottom = _band->firstRow + _band->numRows + 0.0;
    if (centreY + piece.reach[1] < top || centreY - piece.reach[1] > bottom || centreX + piece.reach[0] < _firstColumn - 1.0 ||
        centreX - piece.reach[0] > _lastColumn + 1.0 || piece.IsCollapsed()) {
        return;
    }
    double worst = 0.0;
    for (int k = 0; k < 2; ++k) worst = std::max(worst, piece.GetStray(k, 0.5));
    int const numCells = std::clamp(static_cast<int>(std::ceil(std::sqrt(worst / 0.4))), 1, 256);
    double const half = 0.5 / numCells;
    for (int j = 0; j < numCells; ++j) {
        for (int i = 0; i < numCells; ++i) {
            if (_isTriangle && i + j >= numCells) continue;
            RasterCell(piece, (2 * i + 1) * half - _tree.GetCentre(), (2 * j + 1) * half - _tree.GetCentre(),
                       half, hits);
        }
    }
}

void UVRaster::RasterCell(TexturePiece const& piece, double x, double y, double half, TexelHits& hits) {
    auto const u = piece.Evaluate(0, x, y), v = piece.Evaluate(1, x, y);
    // How far the map strays from its linear part within the cell, plus what counts as covered.
    double const stray[2] = {piece.GetStray(0, half) + 10 * kCoveredTexels, piece.GetStray(1, half) + 10 * kCoveredTexels};
    double const bend = FindBend(piece, u, v);
    double const cx = piece.originX + u[0], cy = piece.originY + v[0];
    double const us = u[1], ut = u[2], vs = v[1], vt = v[2];
    double const reachX = (std::abs(us) + std::abs(ut)) * half + stray[0];
    double const reachY = (std::abs(vs) + std::abs(vt)) * half + stray[1];
    int const firstY = std::max(_band->firstRow, static_cast<int>(std::ceil(cy - reachY)));
    int const lastY = std::min(_band->firstRow + _band->numRows - 1, static_cast<int>(std::floor(cy + reachY)));
    double const det = us * vt - ut * vs;
    double const size = us * us + ut * ut + vs * vs + vt * vt;
    bool const isInvertible = std::abs(det) > 1e-9 * size;
    double const inverse = isInvertible ? 1.0 / det : 0.0;
    double const limitS = half + (stray[0] * std::abs(vt) + stray[1] * std::abs(ut)) * std::abs(inverse);
    double const limitT = half + (stray[0] * std::abs(vs) + stray[1] * std::abs(us)) * std::abs(inverse);
    for (int row = firstY; row <= lastY; ++row) {
        double from = cx - reachX, to = cx + reachX;
        double const dy = row - cy;
        if (isInvertible) {
            // ds = (vt dx - ut dy) / det and dt = (us dy - vs dx) / det must stay within the cell.
            auto const narrow = [&](double slope, double constant, double limit) {
                if (std::abs(slope) < 1e-12) {
                    if (std::abs(constant) > limit) to = from - 1.0;
                    return;
                }
                double const a = (-limit - constant) / slope, b = (limit - constant) / slope;
                from = std::max(from, cx + std::min(a, b));
                to = std::min(to, cx + std::max(a, b));
            };
            narrow(vt * inverse, -ut * dy * inverse, limitS);
            narrow(-vs * inverse, us * dy * inverse, limitT);
        }
        if (from > to) continue;
        int const firstX = std::max(_firstColumn, static_cast<int>(std::ceil(std::max(from, -1.0))));
        int const lastX = std::min(_lastColumn, static_cast<int>(std::floor(std::min(to, 1e9))));
        AddRow(piece, row, firstX, lastX);
        if (_texel.size() >= kFlushAt) Flush(piece, x, y, half, bend, hits);
    }
    Flush(piece, x, y, half, bend, hits);
}

void UVRaster::AddRow(TexturePiece const& piece, int row, int firstX, int lastX) {
    if (firstX > lastX) return;
    size_t const start = _texel.size(), count = static_cast<size_t>(lastX - firstX + 1);
    _texel.resize(start + count);
    _targetX.resize(start + count);
    _targetY.resize(start + count);
    int const texel = (row - _band->firstRow) * _band->width + firstX;
    double const x = firstX - piece.originX, y = row - piece.originY;
    // Accept will ask who owns these texels.
    for (size_t i = 0; i < count; i += 16) __builtin_prefetch(&_band->owner[static_cast<size_t>(texel) + i], 1);
    for (size_t i = 0; i < count; ++i) {
        _texel[start + i] = texel + static_cast<int>(i);
        _targetX[start + i] = x + static_cast<double>(static_cast<int>(i));
        _targetY[start + i] = y;
    }
}

/// Solves for the candidates gathered in the cell about (x, y).
void UVRaster::Flush(TexturePiece const& piece, double x, double y, double half, double bend, TexelHits& hits) {
    size_t const count = _texel.size();
    if (count == 0) return;
    size_t const padded = (count + eval::kInversionLanes - 1) / eval::kInversionLanes * eval::kInversionLanes;
    _targetX.resize(padded, _targetX.back());
    _targetY.resize(padded, _targetY.back());
    _x.resize(padded);
    _y.resize(padded);
    _residual.resize(padded);
    constexpr double kMargin = 0.25;  // iterates may leave the domain this far on their way
    eval::InvertTextureMap({.coefficients = &piece.coefficients[0][0],
                            .targetX = _targetX.data(),
                            .targetY = _targetY.data(),
                            .startX = x,
                            .startY = y,
                            .reach = 2.0 * half,
                            .bend = bend,
                            .low = -_tree.GetCentre() - kMargin,
                            .high = 1.0 - _tree.GetCentre() + kMargin,
                            .x = _x.data(),
                            .y = _y.data(),
                            .residual = _residual.data(),
                            .count = static_cast<int>(count),
                            .maxSteps = kMaxNewtonSteps},
                           _isTriangle);
    Accept(piece, hits);
    _texel.clear();
    _targetX.clear();
    _targetY.clear();
}

/// Keeps the candidates that the face covers.
void UVRaster::Accept(TexturePiece const& piece, TexelHits& hits) {
    size_t const count = _texel.size(), start = hits.texel.size();
    hits.texel.resize(start + count);
    hits.s.resize(start + count);
    hits.t.resize(start + count);
    size_t end = start;
    double const centre = _tree.GetCentre(), scale = piece.domain.scale;
    double const originS = piece.domain.origin[0], originT = piece.domain.origin[1];
    for (size_t i = 0; i < count; ++i) {
        Index& owner = _band->owner[_texel[i]];
        if (owner == _face) continue;  // found from a neighbouring cell or piece before
        double s = _x[i] + centre, t = _y[i] + centre;
        bool const isPlainHit = owner < 0 && _residual[i] <= kCoveredTexels && s >= 0.0 && t >= 0.0 &&
                                (_isTriangle ? s + t <= 1.0 : s <= 1.0 && t <= 1.0);
        if (!isPlainHit && !IsCovered(piece, i, s, t)) continue;
        owner = _face;
        hits.texel[end] = _texel[i];
        hits.s[end] = originS + scale * s;
        hits.t[end] = originT + scale * t;
        ++end;
    }
    hits.texel.resize(end);
    hits.s.resize(end);
    hits.t.resize(end);
}

/// The cases that are not plain hits: at or outside the domain's edge, claimed by another face, or not
/// converged. Clamps (s, t) to the domain; true if the texel is to be this face's.
bool UVRaster::IsCovered(TexturePiece const& piece, size_t candidate, double& s, double& t) {
    int const texel = _texel[candidate];
    double const centre = _tree.GetCentre();
    // The nearest place of the domain.
    double cs = std::clamp(s, 0.0, 1.0), ct = std::clamp(t, 0.0, 1.0);
    if (_isTriangle && cs + ct > 1.0) {
        double const excess = 0.5 * (cs + ct - 1.0);
        cs = std::clamp(cs - excess, 0.0, 1.0);
        ct = 1.0 - cs;
    }
    double const outside = std::max(std::abs(cs - s), std::abs(ct - t));
    if (_residual[candidate] > kCoveredTexels) {
        auto const found = SearchPiece(piece, _targetX[candidate], _targetY[candidate], kCoveredTexels, cs, ct);
        if (found == SearchResult::Undecided) _band->failed[texel] = 1;
        if (found != SearchResult::Found) return false;
    } else if (outside > kClampParameter) {
        if (outside > 0.2) return false;
        // Outside; covered only if the domain's edge passes within kCoveredTexels.
        double const dx = piece.Evaluate(0, cs - centre, ct - centre)[0] - _targetX[candidate];
        double const dy = piece.Evaluate(1, cs - centre, ct - centre)[0] - _targetY[candidate];
        if (dx * dx + dy * dy > kCoveredTexels * kCoveredTexels) return false;
    }
    if (_band->owner[texel] >= 0) {
        double const inside = std::min({cs, ct, _isTriangle ? 1.0 - cs - ct : std::min(1.0 - cs, 1.0 - ct)});
        if (inside > kOverlapParameter && outside == 0.0) _band->overlap[texel] = 1;
        return false;
    }
    s = cs;
    t = ct;
    return true;
}

}  // namespace limn::engine
