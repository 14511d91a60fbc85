// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/dirmag.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include "far_ext/rows/points.h"

namespace limn::eval {

namespace {

using Vector = Eigen::Vector3d;
using far_ext::MutablePoints;
using far_ext::Points;

/// Of the longest coordinate: what is shorter is rounding, the more the farther from the origin the
/// mesh lies, and points anywhere. Its direction would count in means as much as any other.
constexpr double kFlat = 1e-9;

/// The tangent at unit vector q along which the great circle to unit vector n runs, as long as the
/// arc.
Vector LogMap(Vector const& q, Vector const& n) {
    Vector const across = n - n.dot(q) * q;
    double const sine = across.norm();
    return sine > 0.0 ? Vector(across * (std::atan2(sine, n.dot(q)) / sine)) : Vector::Zero();
}

Vector ExpMap(Vector const& q, Vector const& tangent) {
    double const angle = tangent.norm();
    return angle > 0.0
               ? Vector(std::cos(angle) * q + std::sin(angle) / angle * tangent).normalized()
               : q;
}

/// The weighted mean on the sphere of a row's directions.
Vector FindSphericalMean(far_ext::SparseRows const& rows, int row, Points directions) {
    Vector mean = Vector::Zero();
    int largest = rows.offsets[row];
    for (int k = rows.offsets[row]; k < rows.offsets[row + 1]; ++k) {
        mean += rows.weights[k] * directions[rows.indices[k]];
        if (std::abs(rows.weights[k]) > std::abs(rows.weights[largest])) largest = k;
    }
    if (!(mean.norm() > 1e-12)) return directions[rows.indices[largest]];
    Vector q = mean.normalized();
    for (int step = 0; step < 100; ++step) {
        Vector sum = Vector::Zero();
        for (int k = rows.offsets[row]; k < rows.offsets[row + 1]; ++k) {
            sum += rows.weights[k] * LogMap(q, directions[rows.indices[k]]);
        }
        q = ExpMap(q, sum);
        if (sum.norm() < 1e-14) break;
    }
    return q;
}

}  // namespace

std::vector<double> FindAngleNormals(Far::TopologyLevel const& level,
                                     std::span<double const> positions) {
    std::vector<double> sums(positions.size(), 0.0);
    Points const points(positions);
    MutablePoints const normals(sums);
    for (Index face = 0; face < level.GetNumFaces(); ++face) {
        auto const vertices = level.GetFaceVertices(face);
        int const size = vertices.size();
        for (int i = 0; i < size; ++i) {
            auto const p = points[vertices[i]];
            Vector const a = points[vertices[(i + 1) % size]] - p,
                         b = points[vertices[(i + size - 1) % size]] - p;
            Vector const across = a.cross(b);
            double const sine = across.norm();
            if (sine > 0.0) normals[vertices[i]] += across * (std::atan2(sine, a.dot(b)) / sine);
        }
    }
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        Vector const sum = normals[vertex];
        normals[vertex] = sum.norm() > 0.0 ? Vector(sum.normalized()) : Vector(0.0, 0.0, 1.0);
    }
    return sums;
}

DirMag SplitDirMag(Far::TopologyLevel const& level, std::span<double const> positions,
                   std::span<double const> deltas, double flat) {
    DirMag split{{}, FindAngleNormals(level, positions), 0.0};
    Points const points(deltas);
    double longest = 0.0;
    for (size_t i = 0; i < points.GetCount(); ++i) longest = std::max(longest, points[i].norm());
    MutablePoints const directions(split.directions);
    double tangential = 0.0, all = 0.0;
    for (Index vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        Vector const delta = points[vertex], normal = directions[vertex];
        double const along = delta.dot(normal), length = delta.norm();
        tangential += (delta - along * normal).squaredNorm();
        all += delta.squaredNorm();
        double const magnitude = along > 0.0 ? length : -length;
        split.magnitudes.push_back(magnitude);
        if (length > kFlat * longest && length > flat) directions[vertex] = delta / magnitude;
    }
    split.tangentialShare = all > 0.0 ? std::sqrt(tangential / all) : 0.0;
    return split;
}

DirMag SubdivideDirMag(far_ext::SparseRows const& rows, DirMag const& coarse) {
    DirMag fine{{}, {}, coarse.tangentialShare};
    fine.magnitudes.resize(rows.GetNumRows());
    fine.directions.resize(3 * fine.magnitudes.size());
    rows.Apply(coarse.magnitudes.data(), fine.magnitudes.data(), 1);
    MutablePoints const directions(fine.directions);
    tbb::parallel_for(0, rows.GetNumRows(), [&](int row) {
        directions[row] = FindSphericalMean(rows, row, coarse.directions);
    });
    return fine;
}

std::vector<double> JoinDirMag(DirMag const& split) {
    std::vector<double> deltas = split.directions;
    for (size_t i = 0; i < deltas.size(); ++i) deltas[i] *= split.magnitudes[i / 3];
    return deltas;
}

}  // namespace limn::eval
