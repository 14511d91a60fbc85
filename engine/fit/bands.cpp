// SPDX-License-Identifier: Apache-2.0
#include "engine/fit/bands.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "engine/scene/job.h"
#include "engine/scene/same_faces.h"
#include "far_ext/error.h"
#include "far_ext/rows/points.h"

namespace limn::engine {

MeshExtent MeasureExtent(Scene const& scene, Far::TopologyLevel const& level) {
    MeshExtent extent;
    far_ext::Points const points(scene.positions);
    Eigen::Vector3d low = points[0], high = low;
    for (size_t vertex = 1; vertex < points.GetCount(); ++vertex) {
        low = low.cwiseMin(points[vertex]);
        high = high.cwiseMax(points[vertex]);
    }
    for (size_t c = 0; c < 3; ++c) {
        extent.low[c] = low[static_cast<Eigen::Index>(c)];
        extent.high[c] = high[static_cast<Eigen::Index>(c)];
    }
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        if (level.IsEdgeBoundary(edge) || level.IsEdgeNonManifold(edge)) return extent;
    }
    // Tetrahedra from a point near by, which keeps the digits of a mesh far from the origin.
    double sixfold = 0.0;
    size_t corner = 0;
    for (int size : scene.cage.faceSizes) {
        auto const at = [&](size_t i) -> Eigen::Vector3d {
            return points[scene.cage.faceVertices[corner + i]] - low;
        };
        for (int i = 1; i + 1 < size; ++i) sixfold += at(0).dot(at(i).cross(at(i + 1)));
        corner += size;
    }
    extent.volume = sixfold / 6.0;
    return extent;
}

std::vector<std::vector<double>> SplitIntoBands(Scene const& scene, eval::LimitOperator const& A,
                                                int count) {
    eval::RequireFinite(scene.positions, 3);
    std::vector<std::vector<double>> bands;
    std::vector<double> rest = scene.positions;
    eval::ApplyHighPass(A, 3, count, rest, [&](int i, std::span<double const> part) {
        CheckInterrupted();
        // Band i is (E-A)^i A M = (E-A)^i M - (E-A)^(i+1) M.
        if (i > 0) {
            for (size_t k = 0; k < part.size(); ++k) bands.back()[k] -= part[k];
        }
        bands.emplace_back(part.begin(), part.end());
    });
    return bands;
}

namespace {

std::string Describe(Scene const& from, Scene const& to, FaceDifference const& difference) {
    switch (difference.kind) {
        case FaceDifference::Kind::NumVertices:
            return fmt::format("{} and {} vertices", difference.a, difference.b);
        case FaceDifference::Kind::NumFaces:
            return fmt::format("{} and {} faces", difference.a, difference.b);
        default:
            return fmt::format("{} has other vertices than {}", from.NameFace(difference.face),
                               to.NameFace(difference.face));
    }
}

void RequireSameFaces(Scene const& from, Scene const& to) {
    auto const difference = FindFaceDifference(from.cage, to.cage);
    if (!difference) return;
    throw Error(
        ErrorCode::BadMesh,
        fmt::format("{} and {} do not have the same faces: {}; a morph needs the same vertices and "
                    "faces in the same order",
                    from.path, to.path, Describe(from, to, *difference)));
}

}  // namespace

void Morph(Scene const& from, Scene const& to, eval::LimitOperator const& A, int detail,
           double rate, int steps, VisitFrame const& visit) {
    RequireSameFaces(from, to);
    eval::RequireFinite(from.positions, 3);
    eval::RequireFinite(to.positions, 3);
    std::vector<double> Q = from.positions;
    for (int step = 1; step <= steps; ++step) {
        CheckInterrupted();
        eval::MorphStep(A, 3, detail, rate, to.positions, Q);
        visit(step, Q);
    }
}

}  // namespace limn::engine
