// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "engine/cli/filter_options.h"
#include "engine/io/mesh_writer.h"

namespace limn::cli {

Verb AddBands(CLI::App& app) {
    struct BandsArguments {
        std::string mesh, prefix;
        int count = 0;
        FilterOptions filter;
    };
    auto const a = std::make_shared<BandsArguments>();
    CLI::App* const verb =
        app.add_subcommand("bands", "Split a mesh into frequency bands whose sum is the mesh");
    verb->add_option("MESH", a->mesh, "OBJ, PLY or OFF")->required();
    verb->add_option("-o,--output", a->prefix,
                     "PREFIX of PREFIX.band0.obj ... and PREFIX.remainder.obj")
        ->required();
    verb->add_option("--count", a->count, "number of bands, 1 to 1000")
        ->required()
        ->check(CLI::Range(1, 1000));
    a->filter.AddTo(*verb);
    verb->footer(
        "Example:\n  limn bands scenes/spot/spot.obj -o out/spot --count 4 --precision double");
    return {verb, [a](Context& context) {
                auto const mesh = context.Load(a->mesh);
                auto bands = engine::SplitIntoBands(mesh.scene, a->filter.Build(mesh), a->count);
                context.GetReport()["before"] = DescribeExtent(mesh.scene, mesh);
                engine::Scene output = mesh.scene;
                engine::MeshSequence files(context.GetCommon().IsDouble());
                std::vector<std::string> warnings;
                for (size_t i = 0; i < bands.size(); ++i) {
                    std::string const path = i + 1 < bands.size()
                                                 ? fmt::format("{}.band{}.obj", a->prefix, i)
                                                 : a->prefix + ".remainder.obj";
                    output.positions = std::move(bands[i]);
                    files.Add(path, output, i == 0 ? &warnings : nullptr);
                    auto entry = DescribeExtent(output, mesh);
                    entry["file"] = path;
                    context.GetReport()["outputs"].push_back(std::move(entry));
                }
                files.Commit();
                WarnAll(context, warnings);
                return kDone;
            }};
}

}  // namespace limn::cli
