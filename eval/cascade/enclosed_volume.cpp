// SPDX-License-Identifier: Apache-2.0
#include "eval/cascade/enclosed_volume.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "far_ext/rows/points.h"

namespace limn::eval {

namespace {

using far_ext::CascadeMesh;
using Vector = Eigen::Vector3d;
using far_ext::MutablePoints;
using far_ext::Points;

/// Calls visit(a, b, c, share) for all triangles of a mesh; those of a quad's two diagonals have
/// half shares.
template <class Visit>
void ForEachTriangle(CascadeMesh const& mesh, Visit const& visit) {
    size_t const n = mesh.faceSize;
    for (size_t face = 0; face < mesh.faces.size(); face += n) {
        Index const* const f = &mesh.faces[face];
        if (n == 3) {
            visit(f[0], f[1], f[2], 1.0);
        } else {
            for (size_t k = 0; k < 4; ++k) visit(f[k], f[(k + 1) % 4], f[(k + 2) % 4], 0.5);
        }
    }
}

/// d volume / d position, per vertex.
std::vector<Vector> FindGradients(CascadeMesh const& mesh, Points points) {
    std::vector<Vector> gradients(mesh.numVertices, Vector::Zero());
    ForEachTriangle(mesh, [&](Index a, Index b, Index c, double share) {
        Vector const p = points[a], q = points[b], r = points[c];
        Vector const normal = share / 6.0 * (q - p).cross(r - p);
        // The part of the volume's derivative that closed rings leave of (share / 6) q x r.
        for (Index vertex : {a, b, c}) gradients[vertex] += normal;
    });
    return gradients;
}

}  // namespace

std::vector<double> MeasureVolumes(CascadeMesh const& mesh, std::span<int const> componentOfVertex,
                                   int numComponents, std::span<double const> positions) {
    Points const points(positions);
    std::vector<double> volumes(numComponents, 0.0);
    std::vector<Index> origins(volumes.size(), -1);  // near the surface: far ones would cost digits
    ForEachTriangle(mesh, [&](Index a, Index b, Index c, double share) {
        size_t const component = componentOfVertex[a];
        if (origins[component] < 0) origins[component] = a;
        auto const origin = points[origins[component]];
        Vector const p = points[a] - origin, q = points[b] - origin, r = points[c] - origin;
        volumes[component] += share / 6.0 * p.dot(q.cross(r));
    });
    return volumes;
}

std::vector<double> FindVolumeNormals(CascadeMesh const& mesh, std::span<double const> positions) {
    std::vector<double> normals;
    normals.reserve(positions.size());
    for (Vector const& gradient : FindGradients(mesh, positions)) {
        Vector const normal = gradient.normalized();
        normals.insert(normals.end(), {normal.x(), normal.y(), normal.z()});
    }
    return normals;
}

std::vector<char> RestoreVolumes(CascadeMesh const& mesh, std::span<int const> componentOfVertex,
                                 std::span<char const> isWanted, std::span<double const> volumes,
                                 std::span<double const> directions, std::span<double> positions) {
    size_t const numComponents = isWanted.size();
    constexpr int kNewtonSteps = 20;
    constexpr double kTolerance = 1e-12, kMetTolerance = 1e-10;
    std::vector<char> isMet(numComponents, 1);
    std::vector<double> const start(positions.begin(), positions.end());
    Points const starts(start), along(directions);
    MutablePoints const points(positions);
    std::vector<double> factors(numComponents, 0.0);
    for (int step = 0; step <= kNewtonSteps; ++step) {
        auto const present =
            MeasureVolumes(mesh, componentOfVertex, static_cast<int>(numComponents), positions);
        auto const gradients = FindGradients(mesh, positions);
        std::vector<double> slopes(numComponents, 0.0);
        for (size_t vertex = 0; vertex < gradients.size(); ++vertex) {
            if (componentOfVertex[vertex] < 0) continue;
            slopes[componentOfVertex[vertex]] += gradients[vertex].dot(along[vertex]);
        }
        bool isDone = true;
        for (size_t component = 0; component < numComponents; ++component) {
            double const miss = volumes[component] - present[component],
                         size = std::abs(volumes[component]);
            isMet[component] = !isWanted[component] || std::abs(miss) <= kMetTolerance * size;
            if (!isWanted[component] || std::abs(miss) <= kTolerance * size) continue;
            double const change = miss / slopes[component];
            if (!std::isfinite(change)) continue;
            factors[component] += change;
            isDone = false;
        }
        if (isDone || step == kNewtonSteps) break;
        for (size_t vertex = 0; vertex < gradients.size(); ++vertex) {
            if (componentOfVertex[vertex] < 0) continue;
            points[vertex] = starts[vertex] + factors[componentOfVertex[vertex]] * along[vertex];
        }
    }
    for (size_t vertex = 0; vertex < componentOfVertex.size();
         ++vertex) {  // what cannot be met, stays
        if (componentOfVertex[vertex] < 0 || isMet[componentOfVertex[vertex]]) continue;
        points[vertex] = starts[vertex];
    }
    return isMet;
}

}  // namespace limn::eval
