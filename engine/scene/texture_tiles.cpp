// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/texture_tiles.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "eval/surface/patch_polynomial.h"

namespace limn::engine {

namespace {

// Deep enough for any face that has a texel, however far it reaches.
constexpr int kMaxDepth = 48;
// Of a sample's distance to the border: a face that comes this near to a sample may cover it.
constexpr double kNearly = 0.998;
// Of a sum of a piece's terms, more than enough.
constexpr double kRounding = 0x1p-46;
// Texture coordinates are written with six digits; a face that leaves the range by less stays.
constexpr double kRangeSlack = 1e-4;

}  // namespace

struct TextureTiles::Box {
    double minU, maxU, minV, maxV;
    double rounding = 0.0;  // by which it has been widened

    double GetSize() const { return std::max(maxU - minU, maxV - minV); }

    /// True where rounding is more than a tile, so that no texel finds its place.
    bool IsLost() const { return !(rounding <= 1.0); }  // or no number

    /// By the rounding of numbers as large as these.
    Box Widen() const {
        double const u = kRounding * std::max(std::abs(minU), std::abs(maxU)),
                     v = kRounding * std::max(std::abs(minV), std::abs(maxV));
        return {minU - u, maxU + u, minV - v, maxV + v, std::max(u, v)};
    }
};

/// Tiles, first to last in both directions.
struct TextureTiles::Range {
    int firstU, lastU, firstV, lastV;

    bool IsEmpty() const { return firstU > lastU || firstV > lastV; }
    bool IsOne() const { return firstU == lastU && firstV == lastV; }
};

/// A polynomial piece of a face's map.
struct TextureTiles::Piece {
    double coefficients[2][eval::kQuadCoefficients];
    double origin[2];
    eval::PolynomialBounds bounds[2];
};

TextureTiles::TextureTiles(eval::LimitSurface const& surface, std::span<double const> uvs,
                           int width, int height)
    : _tree(surface, uvs, 2),
      _isTriangle(surface.IsLoop()),
      _marginU(kNearly * 0.5 / width),
      _marginV(kNearly * 0.5 / height) {}

/// The tiles of UDIM's range with samples in the box, perhaps; none of a box without numbers.
TextureTiles::Range TextureTiles::FindTiles(Box const& box) const {
    // std::min and std::max answer with their first argument where the second is no number.
    auto const first = [](double low, double margin, int count) {
        return static_cast<int>(
            std::max(0.0, std::min(1.0 * count, std::ceil(low - 1.0 + margin))));
    };
    auto const last = [](double high, double margin, int count) {
        return static_cast<int>(std::min(std::max(-1.0, std::floor(high - margin)), count - 1.0));
    };
    return {first(box.minU, _marginU, 10), last(box.maxU, _marginU, 10),
            first(box.minV, _marginV, kMaxUdimRows), last(box.maxV, _marginV, kMaxUdimRows)};
}

bool TextureTiles::HoldsAll(Range const& tiles) const {
    if (tiles.IsEmpty()) return true;
    unsigned const columns = (2u << tiles.lastU) - (1u << tiles.firstU);
    for (int v = tiles.firstV; v <= tiles.lastV; ++v) {
        if ((_columnsOfRow[v] & columns) != columns) return false;
    }
    return true;
}

bool TextureTiles::HoldsAll(UVBounds const& bounds) const {
    return HoldsAll(FindTiles({bounds.minU, bounds.maxU, bounds.minV, bounds.maxV}));
}

/// Found: the box lies in tiles that are not there yet, all of `tiles`.
TextureTiles::Verdict TextureTiles::Judge(Box const& box, Range const& tiles, bool isLast) const {
    if (HoldsAll(tiles) || (isLast && box.IsLost())) return Verdict::Nothing;
    bool const isSure = tiles.IsOne() && box.minU >= tiles.firstU + _marginU &&
                        box.maxU <= tiles.firstU + 1 - _marginU &&
                        box.minV >= tiles.firstV + _marginV &&
                        box.maxV <= tiles.firstV + 1 - _marginV;
    return isSure || isLast ? Verdict::Found : Verdict::Unclear;
}

/// Asks about the face's domains, and about ever smaller parts of them as long as the answer is
/// unclear. Returns true at the first that is Found.
///
/// \param ask  ask(box, isLast): what a part within the box is; not unclear where it is the last
template <class Ask>
bool TextureTiles::Search(Index face, Ask ask) {
    _tree.Bind(face);
    for (int domain = 0; domain < _tree.GetNumDomains(); ++domain) {
        if (SearchNode(_tree.GetRoot(domain), 0, ask)) return true;
    }
    return false;
}

/// Smaller parts would tell no more.
bool TextureTiles::IsLast(Box const& box, int depth) const {
    return depth >= kMaxDepth || box.GetSize() < 0.25 * std::min(_marginU, _marginV);
}

template <class Ask>
bool TextureTiles::SearchNode(int node, int depth, Ask& ask) {
    auto const u = _tree.GetBounds(node, 0), v = _tree.GetBounds(node, 1);
    Box const box = Box{u[0], u[1], v[0], v[1]}.Widen();
    Verdict const verdict = ask(box, IsLast(box, depth));
    if (verdict != Verdict::Unclear) return verdict == Verdict::Found;
    if (!_tree.IsLeaf(node)) {
        for (int child = 0; child < 4; ++child) {
            if (SearchNode(_tree.GetChild(node, child), depth + 1, ask)) return true;
        }
        return false;
    }
    eval::PatchPoint const leaf = _tree.GetLeaf(node);
    Piece piece;
    for (int k = 0; k < 2; ++k) {
        double const* const c = leaf.coefficients + k * _tree.GetNumCoefficients();
        std::copy_n(c, _tree.GetNumCoefficients(), piece.coefficients[k]);
        piece.origin[k] = leaf.origin[k];
        piece.bounds[k] = eval::BoundPolynomial(_isTriangle, c);
    }
    double const middle = 0.5 - _tree.GetCentre();
    return SearchPiece(piece, middle, middle, 0.5, depth, ask);
}

/// \param x, y, half  a square about the piece's centre
template <class Ask>
bool TextureTiles::SearchPiece(Piece const& piece, double x, double y, double half, int depth,
                               Ask& ask) {
    bool const isOutside = _isTriangle && x + y + 2 * _tree.GetCentre() - 2 * half > 1.0;
    if (isOutside) return false;
    double low[2], high[2], rounding[2];
    for (int k = 0; k < 2; ++k) {
        auto const value = _isTriangle
                               ? eval::EvaluateTrianglePolynomial(piece.coefficients[k], x, y)
                               : eval::EvaluateQuadPolynomial(piece.coefficients[k], x, y);
        rounding[k] = kRounding * (std::abs(piece.origin[k]) + std::abs(piece.coefficients[k][0]) +
                                   piece.bounds[k].reach);
        double const reach = (std::abs(value[1]) + std::abs(value[2])) * half +
                             piece.bounds[k].GetStray(half) + rounding[k];
        low[k] = piece.origin[k] + value[0] - reach;
        high[k] = piece.origin[k] + value[0] + reach;
    }
    Box const box{low[0], high[0], low[1], high[1], std::max(rounding[0], rounding[1])};
    // A part of the piece is as lost as the whole.
    Verdict const verdict = ask(box, box.IsLost() || IsLast(box, depth));
    if (verdict != Verdict::Unclear) return verdict == Verdict::Found;
    double const h = 0.5 * half;
    for (double const dy : {-h, h}) {
        for (double const dx : {-h, h}) {
            if (SearchPiece(piece, x + dx, y + dy, h, depth + 1, ask)) return true;
        }
    }
    return false;
}

void TextureTiles::Add(Index face) {
    Search(face, [&](Box const& box, bool isLast) {
        Range const tiles = FindTiles(box);
        Verdict const verdict = Judge(box, tiles, isLast);
        if (verdict != Verdict::Found) return verdict;
        for (int v = tiles.firstV; v <= tiles.lastV; ++v) {
            for (int u = tiles.firstU; u <= tiles.lastU; ++u) AddTile({u, v});
        }
        return Verdict::Nothing;
    });
}

bool TextureTiles::IsLeftBy(Index face) {
    return Search(face,
                  [&](Box const& box, bool isLast) { return Judge(box, FindTiles(box), isLast); });
}

bool TextureTiles::IsRangeLeftBy(Index face) {
    constexpr double kLow = -kRangeSlack, kHighU = 10.0 + kRangeSlack,
                     kHighV = kMaxUdimRows + kRangeSlack;
    return Search(face, [&](Box const& box, bool isLast) {
        bool const isInside =
            box.minU >= kLow && box.maxU <= kHighU && box.minV >= kLow && box.maxV <= kHighV;
        if (isInside) return Verdict::Nothing;
        bool const isOutside =
            box.maxU < kLow || box.minU > kHighU || box.maxV < kLow || box.minV > kHighV;
        return isOutside || isLast ? Verdict::Found : Verdict::Unclear;
    });
}

size_t TextureTiles::GetCount() const {
    size_t count = 0;
    for (uint16_t const columns : _columnsOfRow) count += std::popcount(columns);
    return count;
}

std::vector<int> TextureTiles::ListNumbers() const {
    std::vector<int> numbers;
    for (int v = 0; v < kMaxUdimRows; ++v) {
        for (int u = 0; u < 10; ++u) {
            if (_columnsOfRow[v] >> u & 1) numbers.push_back(UdimTile{u, v}.GetNumber());
        }
    }
    return numbers;
}

}  // namespace limn::engine
