// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include <limn/engine/fit/fit.h>
#include <limn/engine/io/mesh_reader.h>
#include <limn/engine/io/mesh_writer.h>

namespace engine = limn::engine;

int main(int argc, char** argv) {
    if (argc != 3) return std::puts("usage: fit_mesh MESH OUT"), 2;
    engine::Model const model = engine::Model::Build(engine::ReadMesh(argv[1]));

    engine::Job job;
    engine::FitOptions const options{.tolerance = 1e-9, .target = engine::MeshTarget{argv[2]}};
    engine::FitResult const fit = engine::FitToLimit(model, options, job);
    if (!fit.HasConverged()) return std::puts("no limit surface passes through all vertices"), 4;

    engine::WriteMesh(argv[2], fit.mesh, fit.precision);
    std::printf("%s: residual %.1e after %d steps\n", GetName(fit.report.method),
                fit.report.residual, fit.report.iterations);
    std::printf("the limit misses no vertex by more than %.1e of the mesh's size\n",
                fit.certificate.max);
}
