// SPDX-License-Identifier: Apache-2.0
#include "far_ext/differential/laplacian.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <nanoflann.hpp>

#include "far_ext/error.h"

namespace limn::far_ext {

namespace {

using Level = Far::TopologyLevel;
using Point = std::array<double, 3>;

/// The neighbours of a vertex along the boundary; {-1, -1} inside.
std::array<Index, 2> GetBoundaryNeighbours(Level const& level, Index vertex) {
    std::array<Index, 2> neighbours{-1, -1};
    size_t count = 0;
    for (Index edge : level.GetVertexEdges(vertex)) {
        if (level.IsEdgeBoundary(edge) && count < 2)
            neighbours[count++] = GetOtherEnd(level, edge, vertex);
    }
    return neighbours;
}

/// Appends the curve rule's row of a boundary vertex. \return false for an inner vertex
bool AddBoundaryRow(Level const& level, Index vertex, SparseRows& rows) {
    auto const [a, b] = GetBoundaryNeighbours(level, vertex);
    if (a < 0) return false;
    WeightRow row;
    row.Add(vertex, 1.0);
    row.Add(a, -0.5);
    row.Add(b, -0.5);
    rows.AddRow(row);
    return true;
}

Point PointOf(std::span<double const> positions, Index vertex) {
    double const* const p = positions.data() + 3 * static_cast<size_t>(vertex);
    return {p[0], p[1], p[2]};
}

Point Between(Point const& from, Point const& to) {
    return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
}
double Dot(Point const& a, Point const& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A triangle's vertices, cotangents and squared sides; side k lies opposite corner k.
struct Triangle {
    std::array<Index, 3> vertices;
    std::array<double, 3> cotangents, squares;
    double area;
};

Triangle MeasureTriangle(Level const& level, std::span<double const> positions, Index face) {
    auto const vertices = level.GetFaceVertices(face);
    if (vertices.size() != 3) {
        throw Error(ErrorCode::Unsupported,
                    fmt::format("face {} has {} corners; this Laplacian needs triangles", face,
                                vertices.size()));
    }
    Triangle triangle{{vertices[0], vertices[1], vertices[2]}, {}, {}, 0.0};
    std::array<double, 3> dots;
    for (size_t k = 0; k < 3; ++k) {
        Point const p = PointOf(positions, vertices[static_cast<int>(k)]);
        Point const a = Between(p, PointOf(positions, vertices[static_cast<int>((k + 1) % 3)]));
        Point const b = Between(p, PointOf(positions, vertices[static_cast<int>((k + 2) % 3)]));
        dots[k] = Dot(a, b);
        triangle.squares[(k + 2) % 3] = Dot(a, a);
        triangle.area = 0.5 * std::sqrt(std::max(0.0, Dot(a, a) * Dot(b, b) - dots[k] * dots[k]));
    }
    double const longest =
        std::max({triangle.squares[0], triangle.squares[1], triangle.squares[2]});
    if (!(triangle.area > 1e-12 * longest)) {  // below, cotangents are rounding errors
        throw Error(ErrorCode::BadMesh, fmt::format("face {} (vertices {}, {}, {}) has no area, so "
                                                    "that its angles are not defined; move a "
                                                    "vertex or use the combinatorial Laplacian",
                                                    face, vertices[0], vertices[1], vertices[2]));
    }
    for (size_t k = 0; k < 3; ++k) triangle.cotangents[k] = dots[k] / (2.0 * triangle.area);
    return triangle;
}

/// The share of a triangle's area that is nearest to each corner; in an obtuse one half at the wide
/// angle and a quarter at the others.
std::array<double, 3> SplitArea(Triangle const& triangle) {
    std::array<double, 3> shares;
    auto const& cot = triangle.cotangents;
    auto const widest = static_cast<size_t>(std::min_element(cot.begin(), cot.end()) - cot.begin());
    for (size_t k = 0; k < 3; ++k) {
        size_t const p = (k + 1) % 3, q = (k + 2) % 3;
        shares[k] = cot[widest] < 0.0
                        ? triangle.area * (k == widest ? 0.5 : 0.25)
                        : (triangle.squares[p] * cot[p] + triangle.squares[q] * cot[q]) / 8.0;
    }
    return shares;
}

/// Cotangent weights per edge, and mixed Voronoi areas per vertex where asked for.
std::vector<double> MeasureCotangents(Level const& level, std::span<double const> positions,
                                      std::vector<double>* areas) {
    if (areas) areas->assign(static_cast<size_t>(level.GetNumVertices()), 0.0);
    std::vector<double> weights(static_cast<size_t>(level.GetNumEdges()), 0.0);
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        Triangle const triangle = MeasureTriangle(level, positions, face);
        auto const shares = SplitArea(triangle);
        auto const edges = level.GetFaceEdges(face);
        for (int k = 0; k < 3; ++k) {
            if (areas) (*areas)[triangle.vertices[k]] += shares[k];
            weights[edges[(k + 1) % 3]] +=
                0.5 * triangle.cotangents[k];  // edge k + 1 lies opposite corner k
        }
    }
    return weights;
}

/// Positions as nanoflann reads them.
struct PointCloud {
    std::span<double const> positions;
    size_t kdtree_get_point_count() const { return positions.size() / 3; }
    double kdtree_get_pt(size_t index, size_t dimension) const {
        return positions[3 * index + dimension];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

}  // namespace

double FindMeanEdgeLength(Level const& level, std::span<double const> positions) {
    double sum = 0.0;
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const ends = level.GetEdgeVertices(edge);
        Point const side = Between(PointOf(positions, ends[0]), PointOf(positions, ends[1]));
        sum += std::sqrt(Dot(side, side));
    }
    return sum / std::max(1, level.GetNumEdges());
}

void CheckBoundary(Level const& level) {
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (!level.IsVertexBoundary(vertex)) continue;
        int count = 0;
        for (Index edge : level.GetVertexEdges(vertex)) count += level.IsEdgeBoundary(edge);
        if (count == 0 || count == 2) continue;
        throw Error(ErrorCode::BadMesh,
                    fmt::format("vertex {} has {} boundary edges; at most one boundary can pass a "
                                "vertex, so split it",
                                vertex, count));
    }
}

std::vector<std::vector<Index>> FindBoundaryLoops(Level const& level) {
    std::vector<char> isDone(static_cast<size_t>(level.GetNumVertices()), 0);
    std::vector<std::vector<Index>> loops;
    for (Index start = 0; start < level.GetNumVertices(); ++start) {
        if (isDone[start] || GetBoundaryNeighbours(level, start)[0] < 0) continue;
        std::vector<Index> loop;
        for (Index at = start; !isDone[at];) {
            isDone[at] = 1;
            loop.push_back(at);
            auto const [a, b] = GetBoundaryNeighbours(level, at);
            at = isDone[a] ? b : a;
        }
        loops.push_back(std::move(loop));
    }
    return loops;
}

SparseRows BuildCombinatorialLaplacian(Level const& level) {
    CheckBoundary(level);
    SparseRows rows;
    WeightRow row;
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (AddBoundaryRow(level, vertex, rows)) continue;
        auto const edges = level.GetVertexEdges(vertex);
        row.Clear();
        if (edges.size() > 0) row.Add(vertex, 1.0);
        for (Index edge : edges) row.Add(GetOtherEnd(level, edge, vertex), -1.0 / edges.size());
        rows.AddRow(row);
    }
    return rows;
}

AreaLaplacian BuildCotangentLaplacian(Level const& level, std::span<double const> positions) {
    CheckBoundary(level);
    AreaLaplacian laplacian;
    std::vector<double> const weights = MeasureCotangents(level, positions, &laplacian.areas);
    WeightRow row;
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        auto const edges = level.GetVertexEdges(vertex);
        bool const isBoundary = AddBoundaryRow(level, vertex, laplacian.rows);
        if (isBoundary || edges.size() == 0) laplacian.areas[vertex] = 1.0;
        if (isBoundary) continue;
        row.Clear();
        for (Index edge : edges) {
            row.Add(vertex, weights[edge]);
            row.Add(GetOtherEnd(level, edge, vertex), -weights[edge]);
        }
        laplacian.rows.AddRow(row);
    }
    return laplacian;
}

std::vector<double> FindCotangentWeights(Level const& level, std::span<double const> positions) {
    return MeasureCotangents(level, positions, nullptr);
}

AreaLaplacian BuildHeatLaplacian(Level const& level, std::span<double const> positions,
                                 HeatKernel* kernel) {
    CheckBoundary(level);
    constexpr double kLeftOut = 1e-6;  // of the kernel's middle
    std::vector<double> areas(static_cast<size_t>(level.GetNumVertices()), 0.0);
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        Triangle const triangle = MeasureTriangle(level, positions, face);
        for (Index vertex : triangle.vertices) areas[vertex] += triangle.area / 3.0;
    }
    double const edge = FindMeanEdgeLength(level, positions), time = edge * edge;
    double const squaredRadius = 4.0 * time * std::log(1.0 / kLeftOut),
                 scale = 1.0 / (4.0 * std::numbers::pi * time * time);

    using Tree =
        nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointCloud>,
                                            PointCloud, 3, uint32_t>;
    PointCloud const cloud{positions};
    Tree const tree(3, cloud);
    std::vector<std::pair<uint32_t, double>> near;
    AreaLaplacian laplacian;
    laplacian.areas.assign(areas.size(), 1.0);
    double total = 0.0;
    for (double area : areas) total += area;
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (AddBoundaryRow(level, vertex, laplacian.rows)) continue;
        if (level.GetVertexEdges(vertex).size() > 0) {
            tree.radiusSearch(&positions[3 * static_cast<size_t>(vertex)], squaredRadius, near,
                              nanoflann::SearchParams(32, 0.0f, false));
            std::sort(near.begin(),
                      near.end());  // by index: the order of sums does not depend on the tree
            double sum = 0.0;
            for (auto& [index, square] : near) {
                square = index == static_cast<uint32_t>(vertex)
                             ? 0.0
                             : scale * areas[index] * std::exp(-square / (4.0 * time));
                sum += square;
            }
            for (auto const& [index, weight] : near) {
                laplacian.rows.indices.push_back(static_cast<Index>(index));
                laplacian.rows.weights.push_back(index == static_cast<uint32_t>(vertex) ? sum
                                                                                        : -weight);
            }
        }
        if (laplacian.rows.indices.size() > static_cast<size_t>(std::numeric_limits<int>::max())) {
            throw Error(ErrorCode::TooLarge,
                        fmt::format("the mesh Laplace operator of {} vertices passes 2^31 weights",
                                    level.GetNumVertices()));
        }
        laplacian.rows.offsets.push_back(static_cast<int>(laplacian.rows.indices.size()));
    }
    if (kernel) *kernel = {time, std::sqrt(squaredRadius), scale * total * kLeftOut};
    return laplacian;
}

}  // namespace limn::far_ext
