// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>

#include <limn/eval/surface/surface_sample.h>
#include <limn/far_ext/topology/refiner.h>

// The limit of a cube's corner: own weight 9/24, three edge ends 4/24 each, three face opposites
// 1/24 each.
int main() {
    limn::far_ext::ControlMesh cube;
    cube.numVertices = 8;
    cube.faceSizes.assign(6, 4);
    cube.faceVertices = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    std::vector<double> const points{-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1,
                                     -1, -1, 1,  1, -1, 1,  1, 1, 1,  -1, 1, 1};
    auto const refiner = limn::far_ext::CreateRefiner(cube);
    limn::eval::LimitSurface const surface(*refiner);
    limn::eval::FaceTree tree(surface, points, 3);
    tree.Bind(0);
    auto const corner = limn::eval::EvaluateSample(tree, 0, 0.0, 0.0);
    // x of corner (-1,-1,-1), of its edge ends (1, -1, -1) and of its face opposites (1, 1, -1).
    double const expected = -(9.0 + 4.0 * (1 + 1 - 1) + (1 - 1 - 1) * 1.0) / 24.0;
    std::printf("%.12f %.12f\n", corner.position[0], expected);
    return std::abs(corner.position[0] - expected) < 1e-9 ? 0 : 1;
}
