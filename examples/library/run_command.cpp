// SPDX-License-Identifier: Apache-2.0
#include <limn/engine/cli/run_command.h>

// Whatever mesh a command names: a tetrahedron with edges of length sqrt(8).
class Tetrahedron : public limn::engine::MeshSource {
    limn::engine::Scene Read(std::string const& mesh) override {
        limn::engine::Scene scene;
        scene.path = scene.name = mesh;
        scene.cage.numVertices = 4;
        scene.cage.faceSizes = {3, 3, 3, 3};
        scene.cage.faceVertices = {0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0};
        scene.positions = {1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1};
        return scene;
    }
};

int main(int argc, char** argv) {
    Tetrahedron meshes;
    return limn::cli::RunCommand({argv + 1, argv + argc}, meshes);
}
