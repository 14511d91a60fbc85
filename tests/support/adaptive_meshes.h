// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include <Eigen/Geometry>

#include "engine/scene/scene.h"
#include "support/meshes.h"

namespace limn::test {

/// A cube from -1 to 1 of two triangles a side.
inline engine::Scene MakeTriangleCube() {
    auto const cube = MakeCube();
    std::vector<std::vector<Index>> faces;
    for (size_t face = 0; face < cube.cage.faceVertices.size(); face += 4) {
        Index const* const f = &cube.cage.faceVertices[face];
        faces.push_back({f[0], f[1], f[2]});
        faces.push_back({f[0], f[2], f[3]});
    }
    return MakeScene(cube.positions, faces, Sdc::SCHEME_LOOP);
}

/// A square frame round a square hole, 3 wide, 1 thick, the hole 2 wide: genus 1, 32 vertices, 64
/// triangles.
inline engine::Scene MakeWindowFrame() {
    std::vector<double> positions;
    // Rings of 8 points: outside and inside, in front and behind.
    std::array<std::array<double, 2>, 8> const ring{
        {{1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}}};
    for (double z : {0.25, -0.25}) {
        for (double size : {1.5, 1.0}) {
            for (auto const& [x, y] : ring)
                positions.insert(positions.end(), {size * x, size * y, z});
        }
    }
    std::vector<std::vector<Index>> faces;
    auto const addBand = [&](Index a, Index b) {  // from ring a to ring b, seen with a on the right
        for (Index k = 0; k < 8; ++k) {
            Index const next = (k + 1) % 8;
            faces.push_back({a + k, a + next, b + next});
            faces.push_back({a + k, b + next, b + k});
        }
    };
    addBand(0, 8);    // in front
    addBand(8, 24);   // round the hole
    addBand(24, 16);  // behind
    addBand(16, 0);   // outside
    return MakeScene(std::move(positions), faces, Sdc::SCHEME_LOOP);
}

/// How many triangles run along each edge; of a conforming mesh 1 at boundaries, else 2.
inline std::map<std::array<Index, 2>, int> CountFacesAtEdges(std::vector<Index> const& faces) {
    std::map<std::array<Index, 2>, int> counts;
    for (size_t corner = 0; corner < faces.size(); ++corner) {
        Index const a = faces[corner], b = faces[corner % 3 == 2 ? corner - 2 : corner + 1];
        ++counts[{std::min(a, b), std::max(a, b)}];
    }
    return counts;
}

/// The distance of a point from a triangle.
inline double FindDistance(Eigen::Vector3d const& p, std::array<Eigen::Vector3d, 3> const& t) {
    Eigen::Vector3d const normal = (t[1] - t[0]).cross(t[2] - t[0]);
    bool isInside = normal.squaredNorm() > 0.0;
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < 3; ++k) {
        Eigen::Vector3d const along = t[(k + 1) % 3] - t[k];
        isInside = isInside && normal.cross(along).dot(p - t[k]) >= 0.0;
        double const share =
            std::clamp(along.dot(p - t[k]) / std::max(along.squaredNorm(), 1e-300), 0.0, 1.0);
        nearest = std::min(nearest, (p - t[k] - share * along).norm());
    }
    return isInside ? std::min(nearest, std::abs(normal.dot(p - t[0])) / normal.norm()) : nearest;
}

/// Triangles in cells of a grid, for the nearest one to a point that is at most a cell away.
class TriangleGrid {
public:
    TriangleGrid(engine::Scene const& scene, double cell) : _scene(scene), _cell(cell) {
        auto const& faces = scene.cage.faceVertices;
        for (size_t face = 0; face < faces.size(); face += 3) {
            auto const corners = GetCorners(face);
            Eigen::Vector3d const low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]),
                                  high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
            ForEachCell(low.array() - cell, high.array() + cell,
                        [&](Key const& key) { _cells[key].push_back(face); });
        }
    }

    /// Infinite beyond a cell.
    double FindDistance(Eigen::Vector3d const& point) const {
        double nearest = std::numeric_limits<double>::infinity();
        auto const found = _cells.find(KeyOf(point));
        if (found == _cells.end()) return nearest;
        for (size_t face : found->second)
            nearest = std::min(nearest, test::FindDistance(point, GetCorners(face)));
        return nearest;
    }

private:
    using Key = std::array<int, 3>;

    Key KeyOf(Eigen::Vector3d const& point) const {
        Key key;
        for (int c = 0; c < 3; ++c)
            key[static_cast<size_t>(c)] = static_cast<int>(std::floor(point[c] / _cell));
        return key;
    }
    template <class Visit>
    void ForEachCell(Eigen::Vector3d const& low, Eigen::Vector3d const& high,
                     Visit const& visit) const {
        Key const first = KeyOf(low), last = KeyOf(high);
        for (int x = first[0]; x <= last[0]; ++x) {
            for (int y = first[1]; y <= last[1]; ++y) {
                for (int z = first[2]; z <= last[2]; ++z) visit(Key{x, y, z});
            }
        }
    }
    std::array<Eigen::Vector3d, 3> GetCorners(size_t face) const {
        std::array<Eigen::Vector3d, 3> corners;
        for (size_t k = 0; k < 3; ++k) {
            corners[k] = Eigen::Map<Eigen::Vector3d const>(
                &_scene.positions[3 * static_cast<size_t>(_scene.cage.faceVertices[face + k])]);
        }
        return corners;
    }

    engine::Scene const& _scene;
    double _cell;
    std::map<Key, std::vector<size_t>> _cells;
};

/// The largest distance of vertices and middles of edges and faces of one mesh from the other, both
/// ways; both of triangles, and not farther apart than `reach`.
inline double FindLargestDistance(engine::Scene const& a, engine::Scene const& b, double reach) {
    double largest = 0.0;
    for (auto const& [from, to] : {std::pair(&a, &b), std::pair(&b, &a)}) {
        TriangleGrid const grid(*to, reach);
        auto const& faces = from->cage.faceVertices;
        auto const get = [&](Index vertex) -> Eigen::Vector3d {
            return Eigen::Map<Eigen::Vector3d const>(
                &from->positions[3 * static_cast<size_t>(vertex)]);
        };
        for (size_t face = 0; face < faces.size(); face += 3) {
            Eigen::Vector3d const p = get(faces[face]), q = get(faces[face + 1]),
                                  r = get(faces[face + 2]);
            for (Eigen::Vector3d const& point :
                 {p, Eigen::Vector3d((p + q) / 2), Eigen::Vector3d((q + r) / 2),
                  Eigen::Vector3d((p + q + r) / 3)})
                largest = std::max(largest, grid.FindDistance(point));
        }
    }
    return largest;
}

}  // namespace limn::test
