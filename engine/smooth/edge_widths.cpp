// SPDX-License-Identifier: Apache-2.0
#include "engine/smooth/edge_widths.h"

#include <algorithm>
#include <set>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "engine/io/edge_values.h"
#include "engine/smooth/vertex_widths.h"
#include "far_ext/error.h"
#include "far_ext/rows/points.h"

namespace limn::engine {

namespace {

using Vector = Eigen::Vector3d;
using far_ext::Points;

bool IsVertex(Model const& model, Index vertex) {
    return vertex >= 0 && vertex < model.GetCage().numVertices;
}

double Distance(Vector const& point, std::array<std::array<double, 3>, 2> const& segment) {
    Vector const from(segment[0].data()), along = Vector(segment[1].data()) - from;
    double const square = along.squaredNorm(),
                 t = square > 0.0 ? std::clamp((point - from).dot(along) / square, 0.0, 1.0) : 0.0;
    return (point - from - t * along).norm();
}

constexpr double kReach = 3.0;  // widths from an edge to where its filter ends

/// Share of an edge's width at a distance of x widths: 1 up to x = 1, 0 from kReach on, two
/// derivatives continuous.
double FallOff(double x) {
    double const t = std::clamp((kReach - x) / (kReach - 1.0), 0.0, 1.0);
    return t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

}  // namespace

EdgeWidths::EdgeWidths(Model const& model, std::vector<Edge> edges) : _edges(std::move(edges)) {
    for (auto const& [ends, sigma] : _edges) {
        bool const isEdge = IsVertex(model, ends[0]) && IsVertex(model, ends[1]) &&
                            model.GetLevel().FindEdge(ends[0], ends[1]) != Far::INDEX_INVALID;
        if (isEdge && IsWidth(sigma)) continue;
        throw Error(
            ErrorCode::BadMesh,
            fmt::format("{}: {} as the width of the edge from vertex {} to {}: {}", model.GetPath(),
                        sigma, ends[0], ends[1],
                        isEdge ? "a finite number from 0 up is needed" : "there is no such edge"));
    }
    std::erase_if(_edges, [](Edge const& edge) { return edge.sigma == 0.0; });
    ReachFaces(model);
}

EdgeWidths EdgeWidths::Read(std::string const& path, Model const& model) {
    std::vector<Edge> edges;
    for (EdgeValue const& row : ReadEdgeTable(path, "width", model.GetLevel())) {
        CheckWidth(row.value, path, row.line);
        edges.push_back({{row.from, row.to}, row.value});
    }
    return {model, std::move(edges)};
}

double EdgeWidths::GetLargest() const {
    double largest = 0.0;
    for (Edge const& edge : _edges) largest = std::max(largest, edge.sigma);
    return largest;
}

/// Finds the faces near each edge, walking over shared vertices: a near face of another sheet is
/// none.
void EdgeWidths::ReachFaces(Model const& model) {
    auto const& level = model.GetLevel();
    Points const points(model.GetPositions());
    std::vector<Eigen::AlignedBox3d> boxes(level.GetNumFaces());
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        for (Index vertex : level.GetFaceVertices(face)) boxes[face].extend(points[vertex]);
    }
    _edgesNearFace.resize(boxes.size());
    for (size_t i = 0; i < _edges.size(); ++i) {
        Vector const p = points[_edges[i].ends[0]], q = points[_edges[i].ends[1]];
        _segments.push_back({std::array{p.x(), p.y(), p.z()}, std::array{q.x(), q.y(), q.z()}});
        Eigen::AlignedBox3d around(p.cwiseMin(q), p.cwiseMax(q));
        double const reach = kReach * _edges[i].sigma;
        around.extend(around.max() + Vector::Constant(reach));
        around.extend(around.min() - Vector::Constant(reach));
        std::vector<Index> front;
        std::set<Index> seen;
        auto const visit = [&](Index vertex) {
            for (Index face : level.GetVertexFaces(vertex)) {
                if (around.intersects(boxes[face]) && seen.insert(face).second)
                    front.push_back(face);
            }
        };
        for (Index end : _edges[i].ends) visit(end);
        while (!front.empty()) {
            Index const face = front.back();
            front.pop_back();
            _edgesNearFace[face].push_back(static_cast<int>(i));
            for (Index vertex : level.GetFaceVertices(face)) visit(vertex);
        }
    }
}

std::vector<double> EdgeWidths::Sample(SmoothLevels const& levels,
                                       std::vector<double> const& positions) const {
    auto const& mesh = levels.GetMesh();
    std::vector<double> widths(mesh.numVertices, 0.0);
    Points const points(positions);
    auto const baseFaces = levels.FindBaseFaces();
    for (size_t face = 0; face < baseFaces.size(); ++face) {
        for (int i : _edgesNearFace[baseFaces[face]]) {
            for (int k = 0; k < mesh.faceSize; ++k) {
                Index const vertex = mesh.faces[face * mesh.faceSize + k];
                double const sigma = _edges[i].sigma;
                widths[vertex] =
                    std::max(widths[vertex],
                             sigma * FallOff(Distance(points[vertex], _segments[i]) / sigma));
            }
        }
    }
    return widths;
}

}  // namespace limn::engine
