// SPDX-License-Identifier: Apache-2.0
#include "engine/smooth/smooth_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <variant>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "engine/scene/defects.h"
#include "engine/smooth/smooth.h"
#include "far_ext/error.h"
#include "far_ext/rows/points.h"
#include "far_ext/topology/face_components.h"

namespace limn::engine {

SmoothComponents::SmoothComponents(Far::TopologyLevel const& level) {
    auto const faces = far_ext::FaceComponents::Find(level);
    count = faces.count;
    ofVertex.assign(level.GetNumVertices(), -1);
    isClosed.assign(count, 1);
    firstVertex.assign(count, -1);
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        auto const around = level.GetVertexFaces(vertex);
        if (around.size() == 0) continue;
        int const component = ofVertex[vertex] = faces.ofFace[around[0]];
        if (firstVertex[component] < 0) firstVertex[component] = vertex;
    }
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const around = level.GetEdgeFaces(edge);
        if (around.size() == 1) isClosed[faces.ofFace[around[0]]] = 0;
    }
}

void RefuseDefects(Model const& model, Job& job) {
    for (Defect const& defect : FindDefects(model)) {
        for (char const* kind : {"non_manifold_edge", "non_manifold_vertex", "winding",
                                 "not_orientable", "repeated_corner"}) {
            if (defect.kind == kind)
                throw Error(
                    ErrorCode::BadMesh,
                    fmt::format("{}: {}; a geometric filter needs a manifold, oriented one way",
                                model.GetPath(), defect.message));
        }
        job.Warn(fmt::format("{}: {}", model.GetPath(), defect.message));
    }
}

void RequireGraph(Model const& model) {
    auto const& level = model.GetLevel();
    far_ext::Points const points(model.GetPositions());
    double direction = 0.0;
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        auto const vertices = level.GetFaceVertices(face);
        int const n = vertices.size();
        for (int k = 0; k < n; ++k) {
            Eigen::Vector3d const a = points[vertices[k]], b = points[vertices[(k + 1) % n]],
                                  c = points[vertices[(k + 2) % n]];
            double const turn = (b - a).x() * (c - b).y() - (b - a).y() * (c - b).x();
            if (direction == 0.0) direction = turn;
            if (turn != 0.0 && (turn > 0.0) == (direction > 0.0)) continue;
            throw Error(ErrorCode::BadMesh,
                        fmt::format("{}: {} is folded, hollow or without area in the plane of x "
                                    "and y; `Graph` needs heights z over a "
                                    "plane of convex faces",
                                    model.GetPath(), model.NameFace(face)));
        }
    }
}

void RequireTriangles(Model const& model, char const* member) {
    auto const& sizes = model.GetCage().faceSizes;
    auto const other = std::find_if(sizes.begin(), sizes.end(), [](int size) { return size != 3; });
    if (other == sizes.end()) return;
    throw Error(
        ErrorCode::BadMesh,
        fmt::format("{}: {} has {} corners; `{}` needs triangles", model.GetPath(),
                    model.NameFace(static_cast<Index>(other - sizes.begin())), *other, member));
}

void CheckOptions(SmoothOptions const& options) {
    bool const isJacobi = options.solver == eval::CascadeSolver::Jacobi;
    auto const refuse = [](bool isWrong, std::string const& message) {
        if (isWrong) throw Error(ErrorCode::BadOption, message);
    };
    refuse(isJacobi && std::holds_alternative<StopAtResidual>(options.stop),
           "Jacobi sweeps do not watch the residual; `stop` needs their number");
    refuse(options.order != 2 && options.order != 4,
           fmt::format("`order`: {} is neither 2 nor 4", options.order));
    refuse(options.steps < 1, fmt::format("`steps`: {} is not 1 or more", options.steps));
    refuse(options.evaluator && !isJacobi,
           "`evaluator` needs `solver` jacobi; what cg and exact apply is no fixed table");
    if (options.keepsSweeps) {
        refuse(!isJacobi, "`keepsSweeps` needs `solver` jacobi; cg and exact do not sweep");
        refuse(options.steps != 1, "`keepsSweeps` and `steps` exclude each other: a pair a level");
        refuse(options.settle.has_value(),
               "`keepsSweeps` and `settle` exclude each other: a pair a level");
    }
    if (options.order == 4) {
        refuse(options.levels != 0, "`order` 4 needs `levels` 0");
        refuse(isJacobi, "`order` 4 is not for `solver` jacobi; cg and exact solve it");
        refuse(options.boundary == far_ext::BoundaryRule::Natural,
               "`order` 4 does not go with `Natural`: boundaries are fixed");
        refuse(options.keptFeatures.has_value(), "`order` 4 and `keptFeatures` exclude each other");
    }
    if (options.keptFeatures) {
        refuse(!(*options.keptFeatures > 0.0),
               fmt::format("`keptFeatures`: {} is not above 0", *options.keptFeatures));
        refuse(options.levels != 0, "`keptFeatures` needs `levels` 0");
        refuse(isJacobi, "`keptFeatures` is not for `solver` jacobi; cg and exact solve it");
        refuse(options.constraint == SmoothConstraint::Graph,
               "`keptFeatures` and `Graph` exclude each other");
    }
    if (options.adaptive) {
        refuse(!(*options.adaptive > 0.0),
               fmt::format("`adaptive`: {} is not above 0", *options.adaptive));
        refuse(options.levels < 1 || options.levels > 10,
               fmt::format("`levels`: {} is not from 1 to 10 with `adaptive`", options.levels));
        refuse(isJacobi, "`adaptive` is not for `solver` jacobi; cg and exact solve each pass");
        refuse(std::holds_alternative<SweepsOnFinest>(options.stop),
               "`adaptive` and `stop` exclude each other: nobody knows how many levels follow");
        refuse(options.steps != 1, "`adaptive` and `steps` exclude each other");
        refuse(options.settle.has_value(),
               "`adaptive` and `settle` exclude each other: it settles by itself");
    }
}

void WarnOfSharpCorners(Model const& model, far_ext::CascadeLevel const& first,
                        std::vector<double> const& widths, Job& job) {
    auto const& level = model.GetLevel();
    far_ext::Points const points(model.GetPositions());
    std::vector<double> angles(level.GetNumVertices(), 0.0);
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        auto const vertices = level.GetFaceVertices(face);
        int const n = vertices.size();
        for (int k = 0; k < n; ++k) {
            auto const corner = points[vertices[k]];
            Eigen::Vector3d const a = points[vertices[(k + n - 1) % n]] - corner,
                                  b = points[vertices[(k + 1) % n]] - corner;
            angles[vertices[k]] += std::atan2(a.cross(b).norm(), a.dot(b));
        }
    }
    constexpr double kHalfTurn = std::numbers::pi * (1.0 - 1e-9);
    int count = 0;
    Index sharpest = -1;
    for (Index row = 0; row < first.numClosed; ++row) {
        Index const vertex = first.vertices[row];
        if (vertex >= level.GetNumVertices() || angles[vertex] >= kHalfTurn ||
            (!widths.empty() && widths[vertex] == 0.0))
            continue;
        ++count;
        if (sharpest < 0 || angles[vertex] < angles[sharpest]) sharpest = vertex;
    }
    if (count == 0) return;
    job.Warn(fmt::format(
        "{}: at vertex {}{} the faces' angles add up to {:.1f} degrees; below 180 the "
        "filter's triangles degenerate with the levels",
        model.GetPath(), sharpest, count > 1 ? fmt::format(" and {} more", count - 1) : "",
        angles[sharpest] * 180.0 / std::numbers::pi));
}

}  // namespace limn::engine
