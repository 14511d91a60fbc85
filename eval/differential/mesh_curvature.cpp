// SPDX-License-Identifier: Apache-2.0
#include "eval/differential/mesh_curvature.h"

#include <cmath>

#include <Eigen/Dense>
#include <tbb/parallel_for.h>

#include "far_ext/rows/points.h"
#include "far_ext/topology/boundary.h"

namespace limn::eval {

namespace {

using Level = Far::TopologyLevel;
using Vector = Eigen::Vector3d;
using far_ext::MutablePoints;
using far_ext::Points;

/// The angle by which faces turn across an edge; positive where it is convex.
double FindDihedral(Level const& level, Points points, Points normals, Index edge) {
    auto const faces = level.GetEdgeFaces(edge);
    Index const from = level.GetEdgeVertices(edge)[0], to = level.GetEdgeVertices(edge)[1];
    Vector const a = normals[faces[0]], b = normals[faces[1]];
    // The edge as the first face goes round it.
    auto const vertices = level.GetFaceVertices(faces[0]);
    int const corner = level.GetEdgeFaceLocalIndices(edge)[0];
    bool const isForward = vertices[corner] == from;
    Vector const along = (points[to] - points[from]).normalized() * (isForward ? 1.0 : -1.0);
    return std::atan2(a.cross(b).dot(along), a.dot(b));
}

bool HasCurvature(Level const& level, Index vertex) {
    if (level.GetVertexFaces(vertex).size() == 0) return false;
    for (Index edge : level.GetVertexEdges(vertex)) {
        if (level.GetEdgeFaces(edge).size() != 2) return false;
    }
    return true;
}

}  // namespace

std::vector<double> FindFaceNormals(Level const& level, std::span<double const> positions) {
    std::vector<double> normals(size_t{3} * level.GetNumFaces());
    Points const points(positions);
    MutablePoints const sums(normals);
    tbb::parallel_for(0, level.GetNumFaces(), [&](Index face) {
        auto const vertices = level.GetFaceVertices(face);
        Vector const origin = points[vertices[0]];
        Vector sum = Vector::Zero();
        for (int i = 1; i + 1 < vertices.size(); ++i) {
            sum += 0.5 * (points[vertices[i]] - origin).cross(points[vertices[i + 1]] - origin);
        }
        sums[face] = sum;
    });
    return normals;
}

MeshCurvature MeasureMeshCurvature(Level const& level, std::span<double const> positions,
                                   Orientation orientation) {
    size_t const numVertices = level.GetNumVertices();
    std::vector<double> const faceNormals = FindFaceNormals(level, positions);
    Points const points(positions), normals(faceNormals);
    std::vector<double> bends(level.GetNumEdges(), 0.0);  // |e|/2 beta / |e|^2
    tbb::parallel_for(0, level.GetNumEdges(), [&](Index edge) {
        if (level.GetEdgeFaces(edge).size() != 2) return;
        auto const ends = level.GetEdgeVertices(edge);
        double const length = (points[ends[1]] - points[ends[0]]).norm();
        if (length > 0.0) bends[edge] = 0.5 * FindDihedral(level, points, normals, edge) / length;
    });
    MeshCurvature curvature{std::vector<double>(numVertices, 0.0),
                            std::vector<double>(numVertices, 0.0),
                            std::vector<double>(numVertices, 0.0)};
    tbb::parallel_for(0, level.GetNumVertices(), [&](Index vertex) {
        if (!HasCurvature(level, vertex)) return;
        Vector normal = Vector::Zero();
        double area = 0.0;
        for (Index face : level.GetVertexFaces(vertex)) {
            normal += normals[face];
            area += normals[face].norm() / level.GetFaceVertices(face).size();
        }
        if (!(area > 0.0) || !(normal.norm() > 0.0)) return;
        normal.normalize();
        Vector const u = normal.unitOrthogonal(), v = normal.cross(u);
        double uu = 0.0, uv = 0.0, vv = 0.0;
        for (Index edge : level.GetVertexEdges(vertex)) {
            Vector const side = points[far_ext::GetOtherEnd(level, edge, vertex)] - points[vertex];
            double const a = side.dot(u), b = side.dot(v),
                         bend = GetSign(orientation) * bends[edge] / area;
            uu += bend * a * a;
            uv += bend * a * b;
            vv += bend * b * b;
        }
        double const middle = 0.5 * (uu + vv), spread = std::hypot(0.5 * (uu - vv), uv);
        curvature.areas[vertex] = area;
        curvature.k1[vertex] = middle + spread;
        curvature.k2[vertex] = middle - spread;
    });
    return curvature;
}

ThinPlateEnergy FindThinPlateEnergy(MeshCurvature const& curvature) {
    ThinPlateEnergy energy;
    double area = 0.0;
    for (size_t i = 0; i < curvature.areas.size(); ++i) {
        double const k1 = curvature.k1[i], k2 = curvature.k2[i];
        energy.integral += curvature.areas[i] * (k1 * k1 + k2 * k2);
        area += curvature.areas[i];
    }
    energy.mean = area > 0.0 ? energy.integral / area : 0.0;
    return energy;
}

}  // namespace limn::eval
