// SPDX-License-Identifier: Apache-2.0
#include "support/form_meshes.h"

#include <cmath>
#include <map>

#include "support/fit_meshes.h"
#include "support/meshes.h"

namespace limn::test {

engine::Scene MakeOpenFan(int count, Sdc::SchemeType scheme) {
    bool const isLoop = scheme == Sdc::SCHEME_LOOP;
    std::vector<double> positions{0, 0, 0};
    std::vector<std::vector<Index>> faces;
    double const angle = std::acos(-1.0) / count;
    for (int i = 0; i <= count; ++i) {
        positions.insert(positions.end(), {std::cos(angle * i), std::sin(angle * i), 0.1 * i});
        if (!isLoop)
            positions.insert(positions.end(), {1.6 * std::cos(angle * (i + 0.5)),
                                               1.6 * std::sin(angle * (i + 0.5)), 0.0});
    }
    for (int i = 0; i < count; ++i) {
        if (isLoop)
            faces.push_back({0, 1 + i, 2 + i});
        else
            faces.push_back({0, 1 + 2 * i, 2 + 2 * i, 3 + 2 * i});
    }
    if (!isLoop) positions.resize(positions.size() - 3);  // no far corner after the last face
    return MakeScene(std::move(positions), faces, scheme);
}

engine::Scene MakeTetrahedron() {
    return MakeScene({1, 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1},
                     {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}, Sdc::SCHEME_LOOP);
}

engine::Scene MakeLattice(int n, int m, Sdc::SchemeType scheme) {
    std::vector<double> positions;
    std::vector<std::vector<Index>> faces;
    for (int j = 0; j <= m; ++j) {
        for (int i = 0; i <= n; ++i)
            positions.insert(positions.end(),
                             {static_cast<double>(i), static_cast<double>(j), 0.0});
    }
    for (int j = 0; j < m; ++j) {
        for (int i = 0; i < n; ++i) {
            Index const a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
            if (scheme == Sdc::SCHEME_LOOP) {
                faces.push_back({a, b, c});
                faces.push_back({a, c, d});
            } else {
                faces.push_back({a, b, c, d});
            }
        }
    }
    return MakeScene(std::move(positions), faces, scheme);
}

engine::Scene MakeDodecahedron() {
    // The dual of the icosahedron: a vertex per triangle, a face round each vertex.
    engine::Scene const icosahedron = MakeIcosphere(0);
    auto const& v = icosahedron.cage.faceVertices;
    std::vector<double> positions;
    std::map<std::pair<Index, Index>, Index>
        faceAfter;  // of a directed edge, the face that runs along it
    for (Index f = 0; f < static_cast<Index>(v.size() / 3); ++f) {
        for (size_t c = 0; c < 3; ++c) {
            double sum = 0.0;
            for (size_t j = 0; j < 3; ++j)
                sum += icosahedron.positions[3 * static_cast<size_t>(v[3 * f + j]) + c];
            positions.push_back(sum / 3.0);
        }
        for (size_t j = 0; j < 3; ++j) faceAfter[{v[3 * f + j], v[3 * f + (j + 1) % 3]}] = f;
    }
    std::vector<std::vector<Index>> faces;
    for (Index vertex = 0; vertex < icosahedron.cage.numVertices; ++vertex) {
        Index first = -1;
        for (auto const& [edge, face] : faceAfter) {
            if (edge.first == vertex) {
                first = face;
                break;
            }
        }
        std::vector<Index> ring;
        for (Index face = first; ring.empty() || face != first;) {
            ring.push_back(face);
            size_t j = 0;
            while (v[3 * static_cast<size_t>(face) + j] != vertex) ++j;
            face = faceAfter.at(
                {vertex,
                 v[3 * static_cast<size_t>(face) + (j + 2) % 3]});  // across the side that comes in
        }
        faces.push_back(ring);
    }
    return MakeScene(std::move(positions), faces);
}

namespace {

/// Sharpness on the edges along the first few vertices of a mesh's faces.
void AddCreases(engine::Scene& scene, float sharpness, int count) {
    auto& cage = scene.cage;
    Index at = 0;
    for (int face = 0; face < count && face < static_cast<int>(cage.faceSizes.size()); ++face) {
        cage.creaseVertexPairs.insert(cage.creaseVertexPairs.end(),
                                      {cage.faceVertices[at], cage.faceVertices[at + 1]});
        cage.creaseSharpness.push_back(sharpness);
        at += cage.faceSizes[face];
    }
}

engine::Scene WithScheme(engine::Scene scene, Sdc::SchemeType scheme) {
    scene.cage.scheme = scheme;
    return scene;
}

}  // namespace

std::vector<double> MakeCoordinateForm(Far::TopologyLevel const& level,
                                       std::vector<double> const& positions, size_t axis) {
    std::vector<double> form;
    for (Index edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const ends = level.GetEdgeVertices(edge);
        form.push_back(positions[3 * static_cast<size_t>(std::max(ends[0], ends[1])) + axis] -
                       positions[3 * static_cast<size_t>(std::min(ends[0], ends[1])) + axis]);
    }
    return form;
}

std::vector<std::pair<std::string, engine::Scene>> MakeFormMeshes() {
    constexpr auto kLoop = Sdc::SCHEME_LOOP;
    constexpr auto kCatmark = Sdc::SCHEME_CATMARK;
    std::vector<std::pair<std::string, engine::Scene>> meshes;
    auto const add = [&](std::string name, engine::Scene scene) {
        meshes.emplace_back(std::move(name), std::move(scene));
    };
    add("tetrahedron", MakeTetrahedron());
    add("icosahedron", MakeIcosphere(0));
    add("triangle torus", MakeTriangleTorus(6, 5));
    add("flipped torus", MakeIrregularTriangles(9, 8, 3));
    add("triangle lattice", MakeLattice(5, 4, kLoop));
    add("single triangle", MakeScene({0, 0, 0, 1, 0, 0, 0, 1, 0}, {{0, 1, 2}}, kLoop));
    add("single quad", MakeLattice(1, 1, kCatmark));
    add("strip of quads", MakeLattice(4, 1, kCatmark));
    add("strip of triangles", MakeLattice(4, 1, kLoop));
    for (int n = 2; n <= 12; ++n) {
        if (n > 2) add("triangle disk " + std::to_string(n), MakeFan(n, kLoop, 0.1, 0.05));
        add("quad disk " + std::to_string(n), MakeFan(n, kCatmark, 0.1, 0.05));
        if (n > 2) add("bipyramid " + std::to_string(n), MakeBipyramid(n));
        if (n > 2) add("prism " + std::to_string(n), MakePrism(n));
    }
    for (int k = 1; k <= 8; ++k) {
        add("open fan of triangles " + std::to_string(k), MakeOpenFan(k, kLoop));
        add("open fan of quads " + std::to_string(k), MakeOpenFan(k, kCatmark));
    }
    add("cube", MakeCube());
    add("quad torus", MakeTorus(7, 5));
    add("grid with hole", MakeGridWithHole(6, 5));
    add("dodecahedron", MakeDodecahedron());
    add("triangles under Catmull-Clark", WithScheme(MakeIrregularTriangles(7, 6, 2), kCatmark));
    add("mixed open",
        MakeScene({0, 0, 0, 2, 0, 0, 4, 0, 0, 6, 1, 0, 5, 3, 0,
                   3, 2, 0, 1, 2, 0, 0, 4, 0, 2, 5, 0, 4, 5, 0},
                  {{0, 1, 6}, {1, 2, 5, 6}, {2, 3, 4, 5}, {6, 5, 9, 8, 7}, {5, 4, 9}}));
    add("two components", Join({MakeCube(), MakeTorus(5, 4)}));
    for (float sharpness : {10.0f, 0.3f, 1.0f, 2.7f}) {
        for (int count : {1, 2, 5, 40}) {
            std::string const name =
                " with " + std::to_string(count) + " creases of " + std::to_string(sharpness);
            for (auto scheme : {kLoop, kCatmark}) {
                engine::Scene scene =
                    scheme == kLoop ? MakeIrregularTriangles(6, 5, 4) : MakeTorus(6, 5);
                AddCreases(scene, sharpness, count);
                scene.cage.cornerVertices.push_back(3);
                scene.cage.cornerSharpness.push_back(0.6f * sharpness);
                add((scheme == kLoop ? "triangles" : "quads") + name, scene);
                engine::Scene disk = MakeFan(5, scheme, 0.1, 0.05);
                AddCreases(disk, sharpness, count);
                add((scheme == kLoop ? "triangle disk" : "quad disk") + name, disk);
            }
        }
    }
    return meshes;
}

}  // namespace limn::test
