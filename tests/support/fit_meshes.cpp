// SPDX-License-Identifier: Apache-2.0
#include "support/fit_meshes.h"

#include <cmath>
#include <random>

#include "engine/scene/refine.h"
#include "far_ext/topology/refiner.h"
#include "support/meshes.h"
#include "support/triangle_flipper.h"

namespace limn::test {

engine::Scene MakeIrregularTriangles(int n, int m, unsigned seed) {
    engine::Scene scene = MakeTriangleTorus(n, m);
    TriangleFlipper flipper(scene);
    std::mt19937 random(seed);
    for (int i = flipper.GetNumEdges() / 3; i > 0; --i)
        flipper.Flip(static_cast<int>(random() % static_cast<unsigned>(flipper.GetNumEdges())));
    return scene;
}

engine::Scene Refine(engine::Scene const& scene, int levels) {
    engine::Job job;
    return engine::RefineUniformly(engine::Model::Build(scene), {.levels = levels}, job);
}

namespace {

engine::Scene ToSphere(engine::Scene scene) {
    for (size_t i = 0; i < scene.positions.size(); i += 3) {
        double* const p = &scene.positions[i];
        double const length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        for (int c = 0; c < 3; ++c) p[c] /= length;
    }
    return scene;
}

}  // namespace

engine::Scene MakeQuadSphere(int levels) {
    return ToSphere(Refine(MakeCube(), levels));
}

engine::Scene MakeIcosphere(int levels) {
    engine::Scene scene = LoadData("golden_surface/icosa.obj");
    scene.cage.scheme = Sdc::SCHEME_LOOP;
    return ToSphere(Refine(scene, levels));
}

engine::Scene MakeBipyramid(int n) {
    std::vector<double> positions{0, 0, 1, 0, 0, -1};
    std::vector<std::vector<Index>> faces;
    for (int i = 0; i < n; ++i) {
        double const angle = 2 * std::acos(-1.0) * i / n;
        positions.insert(positions.end(), {std::cos(angle), std::sin(angle), 0.0});
        int const a = 2 + i, b = 2 + (i + 1) % n;
        faces.push_back({0, a, b});
        faces.push_back({1, b, a});
    }
    return MakeScene(std::move(positions), faces, Sdc::SCHEME_LOOP);
}

engine::Scene MakePrism(int n) {
    std::vector<double> positions;
    std::vector<std::vector<Index>> faces(2);
    for (int i = 0; i < n; ++i) {
        double const angle = 2 * std::acos(-1.0) * i / n;
        for (double z : {-1.0, 1.0})
            positions.insert(positions.end(), {std::cos(angle), std::sin(angle), z});
        faces[0].insert(faces[0].begin(), 2 * i);
        faces[1].push_back(2 * i + 1);
        int const next = (i + 1) % n;
        faces.push_back({2 * i, 2 * next, 2 * next + 1, 2 * i + 1});
    }
    return MakeScene(std::move(positions), faces);
}

engine::Scene MakeGridWithHole(int n, int m) {
    std::vector<double> positions;
    std::vector<std::vector<Index>> faces;
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= m; ++j) {
            positions.insert(positions.end(), {static_cast<double>(i), static_cast<double>(j),
                                               std::sin(0.7 * i) * std::cos(0.9 * j)});
        }
    }
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < m; ++j) {
            int const a = i * (m + 1) + j, b = a + m + 1;
            if (i != n / 2 || j != m / 2) faces.push_back({a, b, b + 1, a + 1});
        }
    }
    return MakeScene(std::move(positions), faces);
}

void AddNoise(engine::Scene& scene, double share, unsigned seed) {
    auto const& cage = scene.cage;
    double sum = 0.0;
    size_t corner = 0;
    auto const point = [&](Index v) { return &scene.positions[3 * static_cast<size_t>(v)]; };
    for (int size : cage.faceSizes) {
        for (int i = 0; i < size; ++i) {
            double const* const a = point(cage.faceVertices[corner + static_cast<size_t>(i)]);
            double const* const b =
                point(cage.faceVertices[corner + static_cast<size_t>((i + 1) % size)]);
            sum += std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
        }
        corner += static_cast<size_t>(size);
    }
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, share * sum / static_cast<double>(corner));
    for (double& x : scene.positions) x += normal(random);
}

std::vector<engine::Scene> MakeNoisyScenes() {
    std::vector<engine::Scene> scenes{MakeTorus(9, 7), MakeTriangleTorus(8, 6),
                                      MakeGridWithHole(5, 4), MakeCube(),
                                      LoadShape("catmark_cubes_semisharp")};
    for (auto& scene : scenes) AddNoise(scene, 0.1, 2);
    return scenes;
}

engine::Scene Join(std::vector<engine::Scene> const& scenes) {
    engine::Scene all;
    all.path = scenes.front().path;
    all.name = scenes.front().name;
    all.cage.scheme = scenes.front().cage.scheme;
    all.cage.options = scenes.front().cage.options;
    for (engine::Scene const& scene : scenes) {
        Index const first = all.cage.numVertices;
        auto const& cage = scene.cage;
        all.positions.insert(all.positions.end(), scene.positions.begin(), scene.positions.end());
        all.cage.faceSizes.insert(all.cage.faceSizes.end(), cage.faceSizes.begin(),
                                  cage.faceSizes.end());
        for (Index vertex : cage.faceVertices) all.cage.faceVertices.push_back(first + vertex);
        for (Index vertex : cage.creaseVertexPairs)
            all.cage.creaseVertexPairs.push_back(first + vertex);
        all.cage.creaseSharpness.insert(all.cage.creaseSharpness.end(),
                                        cage.creaseSharpness.begin(), cage.creaseSharpness.end());
        all.cage.numVertices += cage.numVertices;
    }
    return all;
}

}  // namespace limn::test
