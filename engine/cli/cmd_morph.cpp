// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "engine/cli/filter_options.h"
#include "engine/io/mesh_writer.h"

namespace limn::cli {

Verb AddMorph(CLI::App& app) {
    struct MorphArguments {
        std::string from, to, prefix;
        int detail = 2, steps = 10;
        double rate = 0.8;
        FilterOptions filter;
    };
    auto const a = std::make_shared<MorphArguments>();
    CLI::App* const verb =
        app.add_subcommand("morph", "Make the meshes in between two meshes of the same topology");
    verb->add_option("FROM", a->from, "OBJ, PLY or OFF")->required();
    verb->add_option("TO", a->to, "the same faces; its tags and UVs are those of the result")
        ->required();
    verb->add_option("-o,--output", a->prefix, "PREFIX of PREFIX.0001.obj ...")->required();
    verb->add_option("--detail", a->detail, "the last band of the difference to keep (default 2)")
        ->check(CLI::Range(0, 1000));
    verb->add_option("--rate", a->rate,
                     "share of the difference that a step keeps, above 0 and below 1 (default 0.8)")
        ->check(CLI::Range(1e-6, 1.0 - 1e-6));
    verb->add_option("--steps", a->steps, "number of meshes (default 10)")
        ->check(CLI::Range(1, 9999));
    a->filter.AddTo(*verb);
    verb->footer("Example:\n  limn morph neutral.obj smile.obj -o out/smile --steps 12");
    return {verb, [a](Context& context) {
                auto const from = context.Load(a->from), to = context.Load(a->to);
                auto const A = a->filter.Build(to);
                context.GetReport()["before"] = DescribeExtent(from.scene, from);
                engine::Scene output = to.scene;
                engine::MeshSequence files(context.GetCommon().IsDouble());
                std::vector<std::string> warnings;
                engine::Morph(from.scene, to.scene, A, a->detail, a->rate, a->steps,
                              [&](int step, std::vector<double> const& positions) {
                                  std::string const path =
                                      fmt::format("{}.{:04}.obj", a->prefix, step);
                                  output.positions = positions;
                                  files.Add(path, output, step == 1 ? &warnings : nullptr);
                                  auto entry = DescribeExtent(output, to);
                                  entry["file"] = path;
                                  context.GetReport()["outputs"].push_back(std::move(entry));
                              });
                context.GetReport()["after"] = DescribeExtent(output, to);
                files.Commit();
                WarnAll(context, warnings);
                return kDone;
            }};
}

}  // namespace limn::cli
