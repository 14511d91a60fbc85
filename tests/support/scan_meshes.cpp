// SPDX-License-Identifier: Apache-2.0
#include "support/scan_meshes.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Core>
#include <Eigen/LU>

#include "support/meshes.h"
#include "support/triangle_flipper.h"

namespace limn::test {

namespace {

using Point = Eigen::Vector2d;

/// Triangles in the plane that stay Delaunay's.
class ScatteredTriangles {
public:
    ScatteredTriangles(int side, unsigned seed)
        : _side(side), _random(seed), _scene(MakeGrid(side)), _flipper(_scene) {}

    engine::Scene Make() {
        Scatter(0.24);  // of a cell: every triangle of the grid keeps its winding
        constexpr int kTimes = 3;
        for (int i = 0; i < kTimes; ++i) {
            MakeDelaunay();
            Scatter(0.5);
        }
        MakeDelaunay();
        return std::move(_scene);
    }

private:
    static engine::Scene MakeGrid(int side) {
        std::vector<double> positions;
        std::vector<std::vector<Index>> faces;
        for (int j = 0; j < side; ++j) {
            for (int i = 0; i < side; ++i) {
                positions.insert(positions.end(), {1.0 * i / (side - 1), 1.0 * j / (side - 1), 0});
                if (i == 0 || j == 0) continue;
                Index const d = j * side + i, c = d - 1, b = d - side, a = b - 1;
                faces.push_back({a, b, d});
                faces.push_back({a, d, c});
            }
        }
        return MakeScene(std::move(positions), faces, Sdc::SCHEME_LOOP);
    }

    Point At(Index vertex) const {
        return Point::Map(&_scene.positions[3 * static_cast<size_t>(vertex)]);
    }
    double AreaOf(int face) const {
        Index const* const v = &_scene.cage.faceVertices[3 * static_cast<size_t>(face)];
        Eigen::Matrix2d sides;
        sides << At(v[1]) - At(v[0]), At(v[2]) - At(v[0]);
        return 0.5 * sides.determinant();
    }

    /// Moves each inner point by a share of a cell at random, where no triangle gets too small.
    void Scatter(double share) {
        std::vector<std::vector<int>> facesOf(_scene.positions.size() / 3);
        for (size_t k = 0; k < _scene.cage.faceVertices.size(); ++k)
            facesOf[static_cast<size_t>(_scene.cage.faceVertices[k])].push_back(
                static_cast<int>(k / 3));
        double const cell = 1.0 / (_side - 1);
        for (int j = 1; j + 1 < _side; ++j) {
            for (int i = 1; i + 1 < _side; ++i) {
                Index const vertex = j * _side + i;
                auto point = Point::Map(&_scene.positions[3 * static_cast<size_t>(vertex)]);
                Point const before = point;
                point += share * cell * Point(Draw(), Draw());
                auto const& faces = facesOf[static_cast<size_t>(vertex)];
                if (std::any_of(faces.begin(), faces.end(),
                                [&](int face) { return AreaOf(face) < 0.005 * cell * cell; }))
                    point = before;
            }
        }
    }

    /// From -1 to 1.
    double Draw() { return 0x1p-31 * static_cast<double>(_random()) - 1.0; }

    void MakeDelaunay() {
        std::vector<int> open;
        for (int e = 0; e < _flipper.GetNumEdges(); ++e) open.push_back(e);
        while (!open.empty()) {
            int const e = open.back(), across = _flipper.GetAcross(e);
            open.pop_back();
            if (across < 0 || !IsInCircle(_flipper.GetQuad(e)) || !_flipper.Flip(e)) continue;
            for (int first : {e / 3 * 3, across / 3 * 3}) {
                open.push_back(first);
                open.push_back(first + 1);
            }
        }
    }

    /// Whether the last point lies within the circle through the others.
    bool IsInCircle(std::array<Index, 4> const& quad) const {
        Eigen::Matrix3d rows;
        for (int i = 0; i < 3; ++i) {
            Point const off = At(quad[static_cast<size_t>(i)]) - At(quad[3]);
            rows.row(i) << off.x(), off.y(), off.squaredNorm();
        }
        double const cell = 1.0 / (_side - 1);
        return rows.determinant() > 1e-9 * cell * cell * cell * cell;
    }

    int _side;
    std::mt19937 _random;
    engine::Scene _scene;
    TriangleFlipper _flipper;
};

}  // namespace

engine::Scene MakeScan(int side, unsigned seed) {
    engine::Scene scene = ScatteredTriangles(side, seed).Make();
    for (size_t i = 0; i < scene.positions.size(); i += 3) {
        double const x = scene.positions[i], y = scene.positions[i + 1];
        scene.uvs.insert(scene.uvs.end(), {x, y});
        scene.positions[i + 2] = 0.05 * std::sin(9.0 * x) * std::cos(7.0 * y);
    }
    scene.cage.fvarChannels.push_back({scene.cage.numVertices, scene.cage.faceVertices});
    return scene;
}

}  // namespace limn::test
