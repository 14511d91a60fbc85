// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "engine/cli/filter_options.h"
#include "engine/cli/options/option_rules.h"
#include "engine/fit/morph.h"
#include "engine/io/mesh_writer.h"

namespace limn::cli {

namespace {

std::string NameStep(std::string const& prefix, int step) {
    return fmt::format("{}.{:04}.obj", prefix, step);
}

/// One for all frames: the ends of the way decide.
Precision ChoosePrecision(std::string const& prefix, engine::Model const& from,
                          engine::Model const& to, Context& context) {
    bool const isEndEnough = engine::AreFloatsEnough(engine::FindExtent(to.GetPositions()));
    return context.ChoosePrecision(prefix, (isEndEnough ? from : to).GetPositions());
}

}  // namespace

Verb AddMorph(CLI::App& app) {
    struct MorphArguments {
        std::string from, to, prefix;
        int steps = 10;
        engine::MorphOptions options;
    };
    auto const a = std::make_shared<MorphArguments>();
    CLI::App* const verb =
        app.add_subcommand("morph", "Make the meshes in between two meshes of the same topology");
    verb->add_option("FROM", a->from, "OBJ, PLY or OFF")->required();
    verb->add_option("TO", a->to, "the same faces; its tags and UVs are those of the result")
        ->required();
    verb->add_option("-o,--output", a->prefix, "PREFIX, without an ending, of PREFIX.0001.obj ...")
        ->required();
    AddNumberOption(*verb, "--detail", a->options.detail,
                    "the last band of the difference to keep (default 2)", {0, 1000});
    AddNumberOption(*verb, "--rate", a->options.rate,
                    "share of the difference that a step keeps (default 0.8)", {1e-6, 1.0 - 1e-6});
    AddNumberOption(*verb, "--steps", a->steps, "number of meshes (default 10)", {1, 9999});
    AddAlpha(*verb, a->options.alpha);
    verb->footer("Example:\n  limn morph neutral.obj smile.obj -o out/smile --steps 12");
    return {verb, [a](Context& context) {
                RequirePrefix("-o", a->prefix);
                std::vector<NamedFile> written;
                for (int step = 1; step <= a->steps; ++step)
                    written.push_back({"-o", NameStep(a->prefix, step)});
                context.KeepApart({{"FROM", a->from}, {"TO", a->to}}, written);
                auto const from = context.Load(a->from), to = context.Load(a->to);
                engine::Morph morph(from, to, a->options);
                context.GetReport()["before"] = DescribeExtent(from, from.GetPositions());
                engine::Scene output = to.MakeScene();
                Precision const precision = ChoosePrecision(a->prefix, from, to, context);
                engine::MeshSequence files;
                auto outputs = nlohmann::json::array();
                std::vector<std::string> warnings;
                for (int step = 1; step <= a->steps; ++step) {
                    std::string const path = NameStep(a->prefix, step);
                    output.positions = morph.MakeNext(context.GetJob());
                    context.GetJob().Start("writing " + path);
                    engine::RoundAsWritten(path, precision, output.positions);
                    auto const leftOut = files.Add(path, output, precision);
                    if (step == 1) warnings = leftOut;
                    outputs.push_back(DescribeOutput(path, to, output.positions, precision));
                }
                context.GetReport()["after"] = DescribeExtent(to, output.positions);
                files.Commit();
                context.GetReport()["outputs"] = std::move(outputs);
                context.Warn(warnings);
                return kDone;
            }};
}

}  // namespace limn::cli
