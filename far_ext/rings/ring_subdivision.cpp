// SPDX-License-Identifier: Apache-2.0
#include "far_ext/rings/ring_subdivision.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <opensubdiv/far/primvarRefiner.h>

namespace limn::far_ext {

namespace {

using Level = Far::TopologyLevel;

std::unique_ptr<Far::TopologyRefiner> RefineOnce(FaceRing const& ring, Sdc::SchemeType scheme,
                                                 Sdc::Options options) {
    auto refiner = CreateRingRefiner(ring, scheme, options);
    Far::TopologyRefiner::UniformOptions uniform(1);
    uniform.fullTopologyInLastLevel = true;
    refiner->RefineUniform(uniform);
    return refiner;
}

/// Loop's weights come from a cosine, and which cosine glibc runs depends on the CPU. Rounding the
/// weights, and letting the row's own point take up the rest, makes the same matrices everywhere
/// and keeps their rows at sum 1. (Catmull-Clark's weights are rational.)
void RoundToPortableWeights(WeightRow& row) {
    constexpr double kGrid = 0x1p44;
    WeightRow rounded;
    double sum = 0.0;
    Index largest = -1;
    double largestWeight = -1.0;
    for (auto const& [index, weight] : row.GetEntries()) {
        double const portable = std::nearbyint(weight * kGrid) / kGrid;
        rounded.Add(index, portable);
        sum += portable;
        if (weight > largestWeight) {
            largestWeight = weight;
            largest = index;
        }
    }
    rounded.Add(largest, 1.0 - sum);
    row = rounded;
}

std::vector<WeightRow> RefineIdentity(FaceRing const& ring, Far::TopologyRefiner const& refiner,
                                      bool isVarying) {
    Far::PrimvarRefinerReal<double> const primvars(refiner);
    Level const& fine = refiner.GetLevel(1);
    auto const coarseRows = WeightRow::Identity(ring.GetNumPoints());
    std::vector<WeightRow> rows;
    if (ring.IsFaceVarying()) {
        rows.resize(fine.GetNumFVarValues(0));
        primvars.InterpolateFaceVarying(1, coarseRows, rows, 0);
    } else {
        rows.resize(fine.GetNumVertices());
        isVarying ? primvars.InterpolateVarying(1, coarseRows, rows)
                  : primvars.Interpolate(1, coarseRows, rows);
    }
    if (refiner.GetSchemeType() == Sdc::SCHEME_LOOP) {
        for (WeightRow& row : rows) RoundToPortableWeights(row);
    }
    return rows;
}

/// Finds out whether a ring's face is one polynomial patch, and which points make it.
class PatchFinder {
public:
    PatchFinder(FaceRing const& ring, Far::TopologyRefiner const& refiner,
                std::vector<WeightRow> const& fineRows)
        : _ring(ring), _refiner(refiner), _fineRows(fineRows), _size(ring.GetFaceSizes()[0]) {
        int first = 0;
        for (int size : ring.GetFaceSizes()) {
            _firstCorner.push_back(first);
            first += size;
        }
    }

    SparseRows Find() {
        bool const isLoop = _refiner.GetSchemeType() == Sdc::SCHEME_LOOP;
        if (_size != (isLoop ? 3 : 4)) return {};
        if (IsLinear()) return isLoop ? LinearTriangle() : LinearQuad();
        auto const isSemiSharp = [](auto const& part) {
            return part.sharpness > 0.0f && part.sharpness < kInfiniteSharpness;
        };
        for (int i = 0; i < _ring.GetNumEdges(); ++i) {
            if (isSemiSharp(_ring.GetEdge(i))) return {};
        }
        for (int i = 0; i < _size; ++i) {
            if (isSemiSharp(_ring.GetCorner(i))) return {};
        }
        return isLoop ? FindBoxSpline() : FindBSpline();
    }

private:
    enum class CornerType { Smooth, Crease, Corner, Other };

    struct FaceEdge {
        int face = -1, edge = -1;
        bool Exists() const { return face >= 0; }
    };

    bool IsLinear() const {
        return _refiner.GetSchemeType() == Sdc::SCHEME_BILINEAR ||
               (_ring.IsFaceVarying() && _refiner.GetSchemeOptions().GetFVarLinearInterpolation() ==
                                             Sdc::Options::FVAR_LINEAR_ALL);
    }

    Index Vertex(int face, int corner) const {
        return _ring.GetFaceVertices()[_firstCorner[face] + corner % _ring.GetFaceSizes()[face]];
    }
    Index Point(int face, int corner) const {
        return _ring.GetFacePoints()[_firstCorner[face] + corner % _ring.GetFaceSizes()[face]];
    }

    /// The one face on the other side of an edge, if the surface goes on smoothly across it.
    FaceEdge Across(int face, int edge) const {
        Index const shared =
            _ring.GetFaceEdges()[_firstCorner[face] + edge % _ring.GetFaceSizes()[face]];
        if (_ring.GetEdge(shared).sharpness > 0.0f) return {};
        Index const from = Point(face, edge), to = Point(face, edge + 1);
        FaceEdge found;
        for (int other = 0; other < _ring.GetNumFaces(); ++other) {
            if (other == face) continue;
            for (int i = 0; i < _ring.GetFaceSizes()[other]; ++i) {
                if (_ring.GetFaceEdges()[_firstCorner[other] + i] != shared) continue;
                if (found.Exists() || Point(other, i) != to || Point(other, i + 1) != from)
                    return {};
                found = {other, i};
            }
        }
        return found;
    }

    /// The rule OpenSubdiv used at a corner of the face, read off its weights.
    CornerType GetCornerType(int corner, int regularValence, double regularCentre) const {
        Level const coarse = _refiner.GetLevel(0), fine = _refiner.GetLevel(1);
        Index const childVertex = coarse.GetVertexChildVertex(Vertex(0, corner));
        Index const childFace = coarse.GetFaceChildFaces(0)[corner];
        int const at = fine.GetFaceVertices(childFace).FindIndex(childVertex);
        Index const childPoint =
            _ring.IsFaceVarying() ? fine.GetFaceFVarValues(childFace, 0)[at] : childVertex;

        auto const& entries = _fineRows[childPoint].GetEntries();
        auto const isNear = [](double a, double b) { return std::abs(a - b) < 1e-6; };
        double centre = 0.0;
        for (auto const& [index, weight] : entries) {
            if (index == Point(0, corner)) centre = weight;
        }
        auto const numOthers =
            std::count_if(entries.begin(), entries.end(), [&](auto const& entry) {
                return entry.first != Point(0, corner) && std::abs(entry.second) > 1e-9;
            });
        if (numOthers == 0 && isNear(centre, 1.0)) return CornerType::Corner;
        if (numOthers == 2 && isNear(centre, 0.75)) return CornerType::Crease;
        if (coarse.GetVertexFaces(Vertex(0, corner)).size() == regularValence &&
            isNear(centre, regularCentre)) {
            return CornerType::Smooth;
        }
        return CornerType::Other;
    }

    static WeightRow One(Index point) {
        WeightRow row;
        row.Add(point, 1.0);
        return row;
    }

    /// a + b - c: where the spline's next point lies if it is to end at a boundary.
    static WeightRow Extrapolate(WeightRow const& a, WeightRow const& b, WeightRow const& c) {
        WeightRow row;
        row.AddWithWeight(a, 1.0);
        row.AddWithWeight(b, 1.0);
        row.AddWithWeight(c, -1.0);
        return row;
    }

    static bool IsKnown(WeightRow const& row) { return !row.GetEntries().empty(); }

    // -------- quads

    using Grid = std::array<std::array<WeightRow, 4>, 4>;  // [t][s]

    static SparseRows ToRows(Grid const& grid) {
        SparseRows rows;
        for (auto const& line : grid) {
            for (WeightRow const& row : line) {
                if (!IsKnown(row)) return {};
                rows.AddRow(row);
            }
        }
        return rows;
    }

    void PlaceCorners(Grid& grid) const {
        grid[1][1] = One(Point(0, 0));
        grid[1][2] = One(Point(0, 1));
        grid[2][2] = One(Point(0, 2));
        grid[2][1] = One(Point(0, 3));
    }

    /// Fills the row beyond each sharp edge: 2 P(edge) - P(inside). Edge i runs from corner i.
    static void ExtrapolateBeyond(Grid& grid, std::array<bool, 4> const& isSharp) {
        for (int t = 0; t < 4; ++t) {
            auto& line = grid[t];
            if (!IsKnown(line[1]) || !IsKnown(line[2])) continue;
            if (isSharp[3]) line[0] = Extrapolate(line[1], line[1], line[2]);
            if (isSharp[1]) line[3] = Extrapolate(line[2], line[2], line[1]);
        }
        for (int s = 0; s < 4; ++s) {
            if (!IsKnown(grid[1][s]) || !IsKnown(grid[2][s])) continue;
            if (isSharp[0]) grid[0][s] = Extrapolate(grid[1][s], grid[1][s], grid[2][s]);
            if (isSharp[2]) grid[3][s] = Extrapolate(grid[2][s], grid[2][s], grid[1][s]);
        }
    }

    SparseRows LinearQuad() const {
        Grid grid;
        PlaceCorners(grid);
        ExtrapolateBeyond(grid, {true, true, true, true});
        return ToRows(grid);
    }

    SparseRows FindBSpline() const {
        // Where the points beyond edge i lie: next to its first corner, next to its second one, and
        // beyond its first corner diagonally.
        constexpr int kBeyondFirst[4][2] = {{0, 1}, {1, 3}, {3, 2}, {2, 0}};  // {t, s}
        constexpr int kBeyondSecond[4][2] = {{0, 2}, {2, 3}, {3, 1}, {1, 0}};
        constexpr int kDiagonal[4][2] = {{0, 0}, {0, 3}, {3, 3}, {3, 0}};

        std::array<FaceEdge, 4> across;
        std::array<bool, 4> isSharp{};
        for (int i = 0; i < 4; ++i) {
            across[i] = Across(0, i);
            isSharp[i] = !across[i].Exists();
            if (!isSharp[i] && _ring.GetFaceSizes()[across[i].face] != 4) return {};
        }
        Grid grid;
        PlaceCorners(grid);
        for (int i = 0; i < 4; ++i) {
            if (isSharp[i]) continue;
            auto const [face, edge] = across[i];  // edge runs from corner i + 1 to corner i
            grid[kBeyondFirst[i][0]][kBeyondFirst[i][1]] = One(Point(face, edge + 2));
            grid[kBeyondSecond[i][0]][kBeyondSecond[i][1]] = One(Point(face, edge + 3));
        }
        for (int i = 0; i < 4; ++i) {
            int const previous = (i + 3) % 4;
            switch (GetCornerType(i, 4, 9.0 / 16.0)) {
                case CornerType::Smooth: {
                    if (isSharp[i] || isSharp[previous] || TouchesSharpEdge(i)) return {};
                    // Over the edge behind corner i, then over that face's edge at the corner.
                    FaceEdge const diagonal = Across(across[i].face, across[i].edge + 1);
                    if (!diagonal.Exists() || _ring.GetFaceSizes()[diagonal.face] != 4) return {};
                    grid[kDiagonal[i][0]][kDiagonal[i][1]] =
                        One(Point(diagonal.face, diagonal.edge + 3));
                    break;
                }
                case CornerType::Crease: {
                    if (isSharp[i] == isSharp[previous]) return {};
                    // Of the two faces on this side the other one must end the sector.
                    bool const endsSector =
                        isSharp[previous]
                            ? !Across(across[i].face, (across[i].edge + 1) % 4).Exists()
                            : !Across(across[previous].face, (across[previous].edge + 3) % 4)
                                   .Exists();
                    if (!endsSector) return {};
                    break;
                }
                case CornerType::Corner:
                    if (!isSharp[i] || !isSharp[previous]) return {};
                    break;
                case CornerType::Other:
                    return {};
            }
        }
        ExtrapolateBeyond(grid, isSharp);
        return ToRows(grid);
    }

    bool TouchesSharpEdge(int corner) const {
        auto const edges = _ring.GetCorner(corner).edges;
        return std::any_of(edges.begin(), edges.end(),
                           [&](Index edge) { return _ring.GetEdge(edge).sharpness > 0.0f; });
    }

    // -------- triangles

    static int LatticeIndex(int i, int j) {
        for (int k = 0; k < 12; ++k) {
            if (kBoxSplineLattice[k][0] == i && kBoxSplineLattice[k][1] == j) return k;
        }
        return -1;
    }

    SparseRows LinearTriangle() const {
        SparseRows rows;
        for (auto const& [i, j] : kBoxSplineLattice) {
            WeightRow row;
            row.Add(Point(0, 0), 1.0 - i - j);
            row.Add(Point(0, 1), i);
            row.Add(Point(0, 2), j);
            rows.AddRow(row);
        }
        return rows;
    }

    SparseRows FindBoxSpline() const {
        // The neighbours of each corner on the lattice, counter-clockwise from the next corner.
        constexpr int kHexagon[3][6][2] = {{{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}},
                                           {{0, 1}, {0, 0}, {1, -1}, {2, -1}, {2, 0}, {1, 1}},
                                           {{0, 0}, {1, 0}, {1, 1}, {0, 2}, {-1, 2}, {-1, 1}}};

        std::array<WeightRow, 12> points;
        for (int corner = 0; corner < 3; ++corner) {
            std::array<WeightRow, 6> hexagon;
            if (!WalkHexagon(corner, hexagon)) return {};
            for (int k = 0; k < 6; ++k) {
                points[LatticeIndex(kHexagon[corner][k][0], kHexagon[corner][k][1])] = hexagon[k];
            }
        }
        SparseRows rows;
        for (WeightRow const& row : points) rows.AddRow(row);
        return rows;
    }

    /// The six neighbours of a corner; those beyond a boundary are extrapolated.
    bool WalkHexagon(int corner, std::array<WeightRow, 6>& hexagon) const {
        CornerType const type = GetCornerType(corner, 6, 10.0 / 16.0);
        hexagon[0] = One(Point(0, corner + 1));
        hexagon[1] = One(Point(0, corner + 2));
        int numFaces = 1;
        // Counter-clockwise over the edge that ends at the corner, then clockwise over the other.
        int last = 1;
        for (FaceEdge at = Across(0, (corner + 2) % 3); at.Exists() && at.face != 0 && numFaces < 7;
             at = Across(at.face, (at.edge + 2) % 3)) {
            ++numFaces;
            if (++last < 6) hexagon[last] = One(Point(at.face, at.edge + 2));
        }
        if (type == CornerType::Smooth) return last == 6 && !TouchesSharpEdge(corner);
        if (type != CornerType::Crease) return false;
        int first = 6;
        for (FaceEdge at = Across(0, corner); at.Exists() && at.face != 0 && numFaces < 7;
             at = Across(at.face, (at.edge + 1) % 3)) {
            ++numFaces;
            hexagon[--first] = One(Point(at.face, at.edge + 2));
        }
        if (numFaces != 3) return false;
        // Known: first .. 5, 0 .. last, four in a row; the two between lie beyond the boundary.
        WeightRow const centre = One(Point(0, corner));
        auto const neighbour = [&](int k) -> WeightRow& { return hexagon[(k + 6) % 6]; };
        neighbour(last + 1) = Extrapolate(centre, neighbour(last), neighbour(last - 1));
        neighbour(first - 1) = Extrapolate(centre, neighbour(first), neighbour(first + 1));
        return true;
    }

    FaceRing const& _ring;
    Far::TopologyRefiner const& _refiner;
    std::vector<WeightRow> const& _fineRows;
    int _size;
    std::vector<int> _firstCorner;
};

/// Where a child lies in its parent: one is at each corner, of a triangle another in the middle,
/// turned round. By its number: vertices say nothing where a face repeats one.
SubDomain GetChildDomain(bool isTriangle, size_t child) {
    constexpr SubDomain kQuad[] = {
        {{0.0, 0.0}, 0.5}, {{0.5, 0.0}, 0.5}, {{0.5, 0.5}, 0.5}, {{0.0, 0.5}, 0.5}};
    constexpr SubDomain kTriangle[] = {
        {{0.0, 0.0}, 0.5}, {{0.5, 0.0}, 0.5}, {{0.0, 0.5}, 0.5}, {{0.5, 0.5}, -0.5}};
    return isTriangle ? kTriangle[child] : kQuad[child];
}

/// Points of the faces that share a point, not only a vertex, with the face.
std::vector<Index> FindSupport(FaceRing const& ring) {
    auto const points = ring.GetFacePoints();
    std::vector<char> isOwn(ring.GetNumPoints(), 0), isSupport(isOwn);
    for (int i = 0; i < ring.GetFaceSizes()[0]; ++i) isOwn[points[i]] = 1;
    auto first = points.begin();
    for (int size : ring.GetFaceSizes()) {
        if (std::any_of(first, first + size, [&](Index point) { return isOwn[point]; })) {
            std::for_each(first, first + size, [&](Index point) { isSupport[point] = 1; });
        }
        first += size;
    }
    std::vector<Index> support;
    for (Index point = 0; point < ring.GetNumPoints(); ++point) {
        if (isSupport[point]) support.push_back(point);
    }
    return support;
}

}  // namespace

size_t RingSubdivision::GetNumBytes() const {
    auto const count = [](SparseRows const& rows) {
        return rows.offsets.capacity() * sizeof(int) +
               rows.weights.capacity() * (sizeof(Index) + sizeof(double));
    };
    size_t sum = sizeof(*this) + count(patch) + support.capacity() * sizeof(Index);
    for (Child const& child : children)
        sum += sizeof(child) + child.ring.GetNumBytes() + count(child.weights);
    return sum;
}

RingSubdivision RingSubdivision::Build(FaceRing const& ring, Sdc::SchemeType scheme,
                                       Sdc::Options options, Use use) {
    auto const refiner = RefineOnce(ring, scheme, options);
    auto const fineRows = RefineIdentity(ring, *refiner, use == Use::VaryingRefinement);
    RingSubdivision result;
    if (use == Use::Limit) {
        result.support = FindSupport(ring);
        result.patch = PatchFinder(ring, *refiner, fineRows).Find();
        if (result.IsRegular()) return result;
    }

    Level const coarse = refiner->GetLevel(0), fine = refiner->GetLevel(1);
    FaceRingGatherer gatherer(fine, options, ring.IsFaceVarying() ? 0 : -1);
    bool const isLoop = scheme == Sdc::SCHEME_LOOP;
    bool const isSplitInSubFaces = !isLoop && ring.GetFaceSizes()[0] != 4;
    std::vector<Index> points;
    for (Index childFace : coarse.GetFaceChildFaces(0)) {
        Child child;
        gatherer.Gather(childFace, child.ring, points);
        for (Index point : points) child.weights.AddRow(fineRows[point]);
        if (!isSplitInSubFaces) child.domain = GetChildDomain(isLoop, result.children.size());
        result.children.push_back(std::move(child));
    }
    return result;
}

}  // namespace limn::far_ext
