// SPDX-License-Identifier: Apache-2.0
#include "far_ext/differential/laplacian.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <nanoflann.hpp>

#include "far_ext/differential/triangle.h"
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

std::vector<double> FindDeltas(SparseRows const& laplacian, std::span<double const> positions) {
    Points const points(positions);
    std::vector<double> deltas(positions.size(), 0.0);
    for (Index row = 0; row < laplacian.GetNumRows(); ++row) {
        auto delta = MutablePoints(deltas)[row];
        for (int k = laplacian.offsets[row]; k < laplacian.offsets[row + 1]; ++k)
            delta += laplacian.weights[k] * (points[laplacian.indices[k]] - points[row]);
    }
    return deltas;
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

std::vector<double> FindVertexAreas(Level const& level, std::span<double const> positions) {
    std::vector<double> areas(level.GetNumVertices(), 0.0);
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        Triangle const triangle = MeasureTriangle(level, Points(positions), face);
        for (Index vertex : triangle.vertices) areas[vertex] += triangle.area / 3.0;
    }
    return areas;
}

AreaLaplacian BuildHeatLaplacian(Level const& level, std::span<double const> positions,
                                 HeatKernel* kernel) {
    CheckBoundary(level);
    Points const points(positions);
    constexpr double kLeftOut = 1e-6;  // of the kernel's middle
    std::vector<double> const areas = FindVertexAreas(level, positions);
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
