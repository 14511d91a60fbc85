// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "engine/cli/filter_options.h"
#include "engine/cli/options/option_rules.h"
#include "engine/io/mesh_writer.h"

namespace limn::cli {

namespace {

std::string NameBand(std::string const& prefix, int band) {
    return fmt::format("{}.band{}.obj", prefix, band);
}

}  // namespace

Verb AddBands(CLI::App& app) {
    struct BandsArguments {
        std::string mesh, prefix;
        int count = 0;
        double alpha = 0.0;
    };
    auto const a = std::make_shared<BandsArguments>();
    CLI::App* const verb =
        app.add_subcommand("bands", "Split a mesh into frequency bands whose sum is the mesh");
    verb->add_option("MESH", a->mesh, "OBJ, PLY or OFF")->required();
    verb->add_option("-o,--output", a->prefix,
                     "PREFIX, without an ending, of PREFIX.band0.obj ... and PREFIX.remainder.obj")
        ->required();
    AddNumberOption(*verb, "--count", a->count, "number of bands", {1, 1000})->required();
    AddAlpha(*verb, a->alpha);
    verb->footer(
        "Example:\n  limn bands scenes/spot/spot.obj -o out/spot --count 4 --precision double");
    return {verb, [a](Context& context) {
                RequirePrefix("-o", a->prefix);
                std::vector<NamedFile> written{{"-o", a->prefix + ".remainder.obj"}};
                for (int i = 0; i < a->count; ++i)
                    written.push_back({"-o", NameBand(a->prefix, i)});
                context.KeepApart({{"MESH", a->mesh}}, written);
                auto const model = context.Load(a->mesh);
                auto bands = engine::SplitIntoBands(model, a->count, a->alpha, context.GetJob());
                context.GetReport()["before"] = DescribeExtent(model, model.GetPositions());
                engine::Scene output = model.MakeScene();
                // One for all, so that they add up as well as the mesh is written.
                Precision const precision =
                    context.ChoosePrecision(a->prefix, model.GetPositions());
                engine::MeshSequence files;
                auto outputs = nlohmann::json::array();
                std::vector<std::string> warnings;
                auto const add = [&](std::string const& path, std::vector<double>& positions) {
                    output.positions = std::move(positions);
                    context.GetJob().Start("writing " + path);
                    engine::RoundAsWritten(path, precision, output.positions);
                    auto const leftOut = files.Add(path, output, precision);
                    if (warnings.empty()) warnings = leftOut;  // one file speaks for all
                    outputs.push_back(DescribeOutput(path, model, output.positions, precision));
                };
                for (size_t i = 0; i < bands.bands.size(); ++i)
                    add(NameBand(a->prefix, static_cast<int>(i)), bands.bands[i]);
                add(a->prefix + ".remainder.obj", bands.remainder);
                files.Commit();
                context.GetReport()["outputs"] = std::move(outputs);
                context.Warn(warnings);
                return kDone;
            }};
}

}  // namespace limn::cli
