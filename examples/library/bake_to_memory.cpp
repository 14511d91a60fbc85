// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <span>

#include <limn/engine/bake/bake.h>
#include <limn/engine/io/mesh_reader.h>

namespace engine = limn::engine;

int main(int argc, char** argv) {
    if (argc != 2) return std::puts("usage: bake_to_memory MESH"), 2;
    engine::Model const model = engine::Model::Build(engine::ReadMesh(argv[1]));

    engine::BakeOptions options;
    options.maps = {"normal"};
    options.width = options.height = 256;

    engine::Job job;
    engine::BakedImages const baked = engine::BakeToMemory(model, options, job);
    for (engine::BakedImage const& image : baked.images) {  // one per map and tile
        auto const isCovered = [](float coverage) { return coverage > 0.0f; };
        std::printf("%td texels are covered\n", std::ranges::count_if(image.coverage, isCovered));
        for (int i = 0; i < image.height; i += 32) {  // along the diagonal
            std::span<float const> const normal = image.GetTexel(i, i);
            std::printf("row %d, column %d: %.9g %.9g %.9g, covered %g\n", i, i, normal[0],
                        normal[1], normal[2], image.GetCoverage(i, i));
        }
    }
}
