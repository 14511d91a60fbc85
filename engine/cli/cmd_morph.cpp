// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "engine/cli/filter_options.h"
#include "engine/cli/options/option_rules.h"
#include "engine/fit/morph.h"
#include "engine/fit/morph_schedule.h"
#include "engine/io/mesh_writer.h"

namespace limn::cli {

namespace {

struct MorphArguments {
    std::string from, to, prefix, schedule;
    int numSteps = 10;
    engine::MorphStep step;
    engine::MorphOptions options;
    std::optional<eval::EvaluatorKind> evaluator;
};

std::string NameStep(std::string const& prefix, size_t step) {
    return fmt::format("{}.{:04}.obj", prefix, step);
}

/// One for all frames: the ends of the way decide.
Precision ChoosePrecision(std::string const& prefix, engine::Model const& from,
                          engine::Model const& to, Context& context) {
    bool const isEndEnough = engine::AreFloatsEnough(engine::FindExtent(to.GetPositions()));
    return context.ChoosePrecision(prefix, (isEndEnough ? from : to).GetPositions());
}

engine::MorphOptions MakeOptions(MorphArguments const& a) {
    engine::MorphOptions options = a.options;
    if (a.schedule.empty())
        options.steps.assign(static_cast<size_t>(a.numSteps), a.step);
    else
        options.steps = engine::ReadMorphSchedule(a.schedule);
    return options;
}

int Run(MorphArguments const& a, CLI::App const& verb, Context& context) {
    for (char const* flag : {"--detail", "--rate", "--steps"})
        RefuseTogether(verb, {"--schedule", flag});
    RequirePrefix("-o", a.prefix);
    std::vector<NamedFile> const read{{"FROM", a.from}, {"TO", a.to}, {"--schedule", a.schedule}};
    context.KeepApart(read, {});
    auto options = MakeOptions(a);
    auto const evaluator = MakeEvaluator(a.evaluator, context.GetCommon().precision);
    options.evaluator = evaluator.get();
    std::vector<NamedFile> written;
    for (size_t step = 1; step <= options.steps.size(); ++step)
        written.push_back({"-o", NameStep(a.prefix, step)});
    context.KeepApart(read, written);
    auto const from = context.Load(a.from), to = context.Load(a.to);
    engine::Morph morph(from, to, options);
    context.GetReport()["before"] = DescribeExtent(from, from.GetPositions());
    engine::Scene output = to.MakeScene();
    Precision const precision = ChoosePrecision(a.prefix, from, to, context);
    engine::MeshSequence files;
    auto outputs = nlohmann::json::array();
    std::vector<std::string> warnings;
    for (auto const& [option, path] : written) {
        output.positions = morph.MakeNext(context.GetJob());
        context.GetJob().Start("writing " + path);
        engine::RoundAsWritten(path, precision, output.positions);
        auto const leftOut = files.Add(path, output, precision);
        if (outputs.empty()) warnings = leftOut;  // one file speaks for all
        outputs.push_back(DescribeOutput(path, to, output.positions, precision));
    }
    context.GetReport()["after"] = DescribeExtent(to, output.positions);
    AddToReport(context.GetReport(), evaluator.get());
    files.Commit();
    context.GetReport()["outputs"] = std::move(outputs);
    context.Warn(warnings);
    return kDone;
}

}  // namespace

Verb AddMorph(CLI::App& app) {
    auto const a = std::make_shared<MorphArguments>();
    CLI::App* const verb =
        app.add_subcommand("morph", "Make the meshes in between two meshes of the same topology");
    verb->add_option("FROM", a->from, "OBJ, PLY or OFF")->required();
    verb->add_option("TO", a->to, "the same faces; its tags and UVs are those of the result")
        ->required();
    verb->add_option("-o,--output", a->prefix, "PREFIX, without an ending, of PREFIX.0001.obj ...")
        ->required();
    AddNumberOption(*verb, "--detail", a->step.detail,
                    "the last band of the difference to keep (default 2)", {0, 1000});
    AddNumberOption(*verb, "--rate", a->step.rate,
                    "share of the difference that a step keeps (default 0.8)", {1e-6, 1.0 - 1e-6});
    AddNumberOption(*verb, "--steps", a->numSteps, "number of meshes (default 10)",
                    {1, engine::kMaxMorphSteps});
    verb->add_option("--schedule", a->schedule,
                     "CSV step,detail,rate with a row for each mesh, in place of these three");
    verb->add_flag("--exact-end", a->options.endsExactly,
                   "the last mesh is TO: what the steps leave of the difference is taken off on "
                   "the way");
    AddAlpha(*verb, a->options.rule);
    AddEvaluatorOption(*verb, a->evaluator, "A");
    verb->footer("Example:\n  limn morph neutral.obj smile.obj -o out/smile --steps 12");
    return {verb, [a, verb](Context& context) { return Run(*a, *verb, context); }};
}

}  // namespace limn::cli
