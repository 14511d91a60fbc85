#include <cmath>
#include <cstdio>

#include <limn/eval/surface_sample.h>
#include <limn/far_ext/refiner.h>

// The limit of a cube's corner is 5/9 of the corner: (9 v + 4 * 3 edge ends + 3 face opposites + ...) as
// surface.md 1.1 has it: 9/24 - 3 * 4/24 * ... evaluates to (1 - 2 * (4 * 3 / 24 * 1/3 + 3 / 24 * 2/3)).
int main() {
    limn::far_ext::ControlMesh cube;
    cube.numVertices = 8;
    cube.faceSizes.assign(6, 4);
    cube.faceVertices = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    std::vector<double> const points{-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1};
    auto const refiner = limn::far_ext::CreateRefiner(cube);
    limn::eval::LimitSurface const surface(*refiner);
    limn::eval::FaceTree tree(surface, points, 3);
    tree.Bind(0);
    auto const corner = limn::eval::EvaluateSample(tree, 0, 0.0, 0.0, 1.0);
    // Corner (-1,-1,-1): own weight 9/24, three edge ends 4/24 each, three face opposites 1/24 each.
    double const expected = -(9.0 + 4.0 * (1 + 1 - 1) + (1 - 1 - 1) * 1.0) / 24.0;
    std::printf("%.12f %.12f\n", corner.position[0], expected);
    return std::abs(corner.position[0] - expected) < 1e-9 ? 0 : 1;
}
