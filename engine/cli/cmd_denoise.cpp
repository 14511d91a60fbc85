// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/filter_options.h"
#include "engine/io/mesh_writer.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

template <class Options>
struct FilterArguments {
    std::string mesh, output;
    Options options;
    std::optional<eval::EvaluatorKind> evaluator;
};

template <class Options>
void AddArguments(CLI::App& verb, FilterArguments<Options>& a) {
    verb.add_option("MESH", a.mesh, "OBJ, PLY or OFF")->required();
    verb.add_option("-o,--output", a.output, "mesh to write, .obj or .ply")->required();
    AddNumberOption(verb, "--steps", a.options.steps, "how often (default 1)", {1, 1000});
    AddAlpha(verb, a.options.rule);
    AddEvaluatorOption(verb, a.evaluator, "A");
}

/// Loads, filters the positions and writes, with the sizes before and after in the report.
template <class Options>
int Run(FilterArguments<Options> const& a, Context& context,
        std::vector<double> (*filter)(engine::Model const&, Options const&, engine::Job&)) {
    engine::RequireMeshEnding(a.output);
    context.KeepApart({{"MESH", a.mesh}}, {{"-o", a.output}});
    auto const model = context.Load(a.mesh);
    context.GetReport()["before"] = DescribeExtent(model, model.GetPositions());
    auto const evaluator = MakeEvaluator(a.evaluator, context.GetCommon().precision);
    Options options = a.options;
    options.evaluator = evaluator.get();
    auto positions = filter(model, options, context.GetJob());
    AddToReport(context.GetReport(), evaluator.get());
    WriteFiltered(a.output, model, std::move(positions), context);
    return kDone;
}

}  // namespace

Verb AddDenoise(CLI::App& app) {
    auto const a = std::make_shared<FilterArguments<engine::DenoiseOptions>>();
    CLI::App* const verb =
        app.add_subcommand("denoise", "Smooth a mesh: keep its lowest frequency bands");
    AddArguments(*verb, *a);
    AddNumberOption(*verb, "--detail", a->options.detail,
                    "the last band to keep (default 2); less is smoother", {0, 1000});
    verb->footer("Example:\n  limn denoise scan.ply -o out/scan.smooth.ply --detail 2 --steps 3");
    return {verb, [a](Context& context) { return Run(*a, context, engine::Denoise); }};
}

Verb AddSharpen(CLI::App& app) {
    auto const a = std::make_shared<FilterArguments<engine::SharpenOptions>>();
    CLI::App* const verb =
        app.add_subcommand("sharpen", "Sharpen a mesh: add some of its frequency bands again");
    AddArguments(*verb, *a);
    AddNumberOption(*verb, "--from-band", a->options.first,
                    "first power of the high-pass filter added (default 2)", {1, 1000});
    AddNumberOption(*verb, "--to-band", a->options.last, "last one (default 4)", {1, 1000});
    verb->footer("Example:\n  limn sharpen scenes/spot/spot.obj -o out/spot.sharp.obj");
    return {verb, [a](Context& context) {
                if (a->options.first > a->options.last)
                    throw Error(ErrorCode::BadOption,
                                "--from-band is above --to-band; give them in order");
                return Run(*a, context, engine::Sharpen);
            }};
}

}  // namespace limn::cli
