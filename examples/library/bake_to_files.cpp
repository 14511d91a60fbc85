// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include <limn/engine/bake/bake.h>
#include <limn/engine/io/mesh_reader.h>

namespace engine = limn::engine;

int main(int argc, char** argv) {
    if (argc != 3) return std::puts("usage: bake_to_files MESH PATTERN"), 2;
    engine::Model const model = engine::Model::Build(engine::ReadMesh(argv[1]));

    engine::BakeOptions options;
    options.pattern = argv[2];  // may hold {mesh}, {map} and <UDIM>
    options.maps = {"mean", "normal"};
    options.width = options.height = 256;
    options.hasPreview = true;  // a PNG beside each

    engine::Job job;
    engine::BakeReport const report = engine::Bake(model, options, job);
    for (engine::BakeOutput const& file : report.outputs)
        std::printf("%s: from %.9g to %.9g\n", file.path.c_str(), file.min, file.max);
    std::printf("%zu texels are covered\n", report.texelsCovered);
}
