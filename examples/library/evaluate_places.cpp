// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <limn/engine/evaluate/evaluate.h>

namespace engine = limn::engine;

int main() {
    int const n = 33;  // vertices a side: what a sphere of radius 2 has above the square [-1, 1]^2
    engine::Scene cap;
    cap.name = "cap";  // what errors begin with
    cap.cage.numVertices = n * n;
    for (int i = 0; i < n * n; ++i) {
        double const x = i % n / 16.0 - 1.0, y = i / n / 16.0 - 1.0;
        for (double p : {x, y, std::sqrt(4.0 - x * x - y * y)}) cap.positions.push_back(p);
        if (i % n == n - 1 || i / n == n - 1) continue;  // no face has its first corner there
        cap.cage.faceSizes.push_back(4);
        for (int corner : {i, i + 1, i + n + 1, i + n}) cap.cage.faceVertices.push_back(corner);
    }
    std::vector<limn::Index> faces(1000);
    std::vector<double> s(1000), t(1000);
    for (int i = 0; i < 1000; ++i) {  // 10 x 10 places on each of 10 faces along the diagonal
        faces[i] = n * (10 + i / 100);
        s[i] = i % 10 / 10.0;
        t[i] = i / 10 % 10 / 10.0;
    }
    engine::Job job;
    engine::LimitValues const limit = engine::EvaluateLimit(
        engine::Model::Build(cap), {faces, s, t}, limn::Orientation::Right, job);
    double const *const p = limit.positions.data(), *const normal = limit.normals.data();
    std::printf("place 0: (%.4f, %.4f, %.4f), normal (%.4f, %.4f, %.4f)\n", p[0], p[1], p[2],
                normal[0], normal[1], normal[2]);
    auto const mean = std::ranges::minmax(limit.mean),
               gaussian = std::ranges::minmax(limit.gaussian);
    std::printf("mean curvature %.4f to %.4f, Gaussian curvature %.4f to %.4f\n", mean.min,
                mean.max, gaussian.min, gaussian.max);
}
