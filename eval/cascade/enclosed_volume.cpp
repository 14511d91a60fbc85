// SPDX-License-Identifier: Apache-2.0
#include "eval/cascade/enclosed_volume.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace limn::eval {

namespace {

using far_ext::CascadeMesh;
using Vector = Eigen::Vector3d;

/// Calls visit(a, b, c, share) for all triangles of a mesh; those of a quad's two diagonals have
/// half shares.
template <class Visit>
void ForEachTriangle(CascadeMesh const& mesh, Visit const& visit) {
    size_t const n = static_cast<size_t>(mesh.faceSize);
    for (size_t face = 0; face < mesh.faces.size(); face += n) {
        Index const* const f = &mesh.faces[face];
        if (n == 3) {
            visit(f[0], f[1], f[2], 1.0);
        } else {
            for (size_t k = 0; k < 4; ++k) visit(f[k], f[(k + 1) % 4], f[(k + 2) % 4], 0.5);
        }
    }
}

Vector At(std::span<double const> positions, Index vertex) {
    return Vector(&positions[3 * static_cast<size_t>(vertex)]);
}

/// d volume / d position, per vertex.
std::vector<Vector> FindGradients(CascadeMesh const& mesh, std::span<double const> positions) {
    std::vector<Vector> gradients(static_cast<size_t>(mesh.numVertices), Vector::Zero());
    ForEachTriangle(mesh, [&](Index a, Index b, Index c, double share) {
        Vector const p = At(positions, a), q = At(positions, b), r = At(positions, c);
        Vector const normal = share / 6.0 * (q - p).cross(r - p);
        // The part of the volume's derivative that closed rings leave of (share / 6) q x r.
        for (Index vertex : {a, b, c}) gradients[vertex] += normal;
    });
    return gradients;
}

}  // namespace

std::vector<double> MeasureVolumes(CascadeMesh const& mesh, std::span<int const> componentOfVertex,
                                   int numComponents, std::span<double const> positions) {
    std::vector<double> volumes(static_cast<size_t>(numComponents), 0.0);
    std::vector<Index> origins(volumes.size(), -1);  // near the surface: far ones would cost digits
    ForEachTriangle(mesh, [&](Index a, Index b, Index c, double share) {
        size_t const component = static_cast<size_t>(componentOfVertex[a]);
        if (origins[component] < 0) origins[component] = a;
        Vector const origin = At(positions, origins[component]);
        Vector const p = At(positions, a) - origin, q = At(positions, b) - origin,
                     r = At(positions, c) - origin;
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
    std::vector<double> factors(numComponents, 0.0);
    for (int step = 0; step <= kNewtonSteps; ++step) {
        auto const present =
            MeasureVolumes(mesh, componentOfVertex, static_cast<int>(numComponents), positions);
        auto const gradients = FindGradients(mesh, positions);
        std::vector<double> slopes(numComponents, 0.0);
        for (size_t vertex = 0; vertex < gradients.size(); ++vertex) {
            if (componentOfVertex[vertex] < 0) continue;
            slopes[static_cast<size_t>(componentOfVertex[vertex])] +=
                gradients[vertex].dot(At(directions, static_cast<Index>(vertex)));
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
            double const factor = factors[static_cast<size_t>(componentOfVertex[vertex])];
            for (size_t i = 3 * vertex; i < 3 * vertex + 3; ++i)
                positions[i] = start[i] + factor * directions[i];
        }
    }
    for (size_t vertex = 0; vertex < componentOfVertex.size();
         ++vertex) {  // what cannot be met, stays
        if (componentOfVertex[vertex] < 0 || isMet[static_cast<size_t>(componentOfVertex[vertex])])
            continue;
        std::copy_n(&start[3 * vertex], 3, &positions[3 * vertex]);
    }
    return isMet;
}

}  // namespace limn::eval
