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
#include "far_ext/rows/points.h"
#include "far_ext/topology/boundary.h"

namespace limn::far_ext {

namespace {

using Level = Far::TopologyLevel;

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

/// A triangle's vertices, cotangents and squared sides; side k lies opposite corner k.
struct Triangle {
    std::array<Index, 3> vertices;
    std::array<double, 3> cotangents, squares;
    double area;
};

Triangle MeasureTriangle(Level const& level, Points points, Index face) {
    auto const vertices = level.GetFaceVertices(face);
    if (vertices.size() != 3) {
        throw Error(ErrorCode::Unsupported,
                    fmt::format("face {} has {} corners; this Laplacian needs triangles", face,
                                vertices.size()));
    }
    Triangle triangle{{vertices[0], vertices[1], vertices[2]}, {}, {}, 0.0};
    std::array<double, 3> dots;
    for (size_t k = 0; k < 3; ++k) {
        auto const corner = points[triangle.vertices[k]];
        Eigen::Vector3d const a = points[triangle.vertices[(k + 1) % 3]] - corner,
                              b = points[triangle.vertices[(k + 2) % 3]] - corner;
        dots[k] = a.dot(b);
        double const square = a.squaredNorm();
        triangle.squares[(k + 2) % 3] = square;
        triangle.area =
            0.5 * std::sqrt(std::max(0.0, square * b.squaredNorm() - dots[k] * dots[k]));
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
    size_t const widest = std::min_element(cot.begin(), cot.end()) - cot.begin();
    for (size_t k = 0; k < 3; ++k) {
        size_t const p = (k + 1) % 3, q = (k + 2) % 3;
        shares[k] = cot[widest] < 0.0
                        ? triangle.area * (k == widest ? 0.5 : 0.25)
                        : (triangle.squares[p] * cot[p] + triangle.squares[q] * cot[q]) / 8.0;
    }
    return shares;
}

/// Cotangent weights per edge, and mixed Voronoi areas per vertex where asked for.
std::vector<double> MeasureCotangents(Level const& level, Points points,
                                      std::vector<double>* areas) {
    if (areas) areas->assign(level.GetNumVertices(), 0.0);
    std::vector<double> weights(level.GetNumEdges(), 0.0);
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        Triangle const triangle = MeasureTriangle(level, points, face);
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

#if NANOFLANN_VERSION >= 0x150  // from there on these have other names
using Neighbour = nanoflann::ResultItem<uint32_t, double>;
nanoflann::SearchParameters const kUnsorted(0.0f, false);
#else
using Neighbour = std::pair<uint32_t, double>;
nanoflann::SearchParams const kUnsorted(32, 0.0f, false);
#endif

/// Points as nanoflann reads them.
struct PointCloud {
    Points points;
    size_t kdtree_get_point_count() const { return points.GetCount(); }
    double kdtree_get_pt(size_t index, size_t axis) const {
        return points[index][static_cast<Eigen::Index>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

}  // namespace

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
    Points const points(positions);
    constexpr double kLeftOut = 1e-6;  // of the kernel's middle
    std::vector<double> areas(level.GetNumVertices(), 0.0);
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        Triangle const triangle = MeasureTriangle(level, points, face);
        for (Index vertex : triangle.vertices) areas[vertex] += triangle.area / 3.0;
    }
    double const edge = FindMeanEdgeLength(level, positions), time = edge * edge;
    double const squaredRadius = 4.0 * time * std::log(1.0 / kLeftOut),
                 scale = 1.0 / (4.0 * std::numbers::pi * time * time);

    using Tree =
        nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointCloud>,
                                            PointCloud, 3, uint32_t>;
    PointCloud const cloud{points};
    Tree const tree(3, cloud);
    std::vector<Neighbour> near;
    AreaLaplacian laplacian;
    laplacian.areas.assign(areas.size(), 1.0);
    double total = 0.0;
    for (double area : areas) total += area;
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        if (AddBoundaryRow(level, vertex, laplacian.rows)) continue;
        if (level.GetVertexEdges(vertex).size() > 0) {
            tree.radiusSearch(points[vertex].data(), squaredRadius, near, kUnsorted);
            // By index: the order of sums does not depend on the tree.
            std::sort(near.begin(), near.end(),
                      [](Neighbour const& a, Neighbour const& b) { return a.first < b.first; });
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
