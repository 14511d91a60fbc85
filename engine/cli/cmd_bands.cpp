// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "engine/cli/filter_options.h"
#include "engine/cli/options/band_options.h"
#include "engine/cli/options/option_rules.h"
#include "engine/io/file.h"
#include "engine/io/mesh_writer.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

struct BandsArguments {
    std::string mesh, output;
    std::optional<int> count;
    far_ext::LimitOptions rule;
    std::optional<eval::EvaluatorKind> evaluator;
    BandArguments sum;
};

std::string NameBand(std::string const& prefix, int band) {
    return fmt::format("{}.band{}.obj", prefix, band);
}

/// The mesh of a sum: as it was named where that is a mesh's name, else PREFIX.gain.obj.
std::string NameSum(std::string const& output) {
    std::string const ending = engine::GetEnding(output);
    return ending == ".obj" || ending == ".ply" ? output : output + ".gain.obj";
}

/// Writes a mesh per band.
int WriteBands(BandsArguments const& a, Context& context) {
    if (!a.count) throw Error(ErrorCode::BadOption, "--count is required");
    RequirePrefix("-o", a.output);
    std::vector<NamedFile> written{{"-o", a.output + ".remainder.obj"}};
    for (int i = 0; i < *a.count; ++i) written.push_back({"-o", NameBand(a.output, i)});
    context.KeepApart({{"MESH", a.mesh}}, written);
    auto const model = context.Load(a.mesh);
    auto const evaluator = MakeEvaluator(a.evaluator, context.GetCommon().precision);
    auto bands = engine::SplitIntoBands(model, *a.count, a.rule, context.GetJob(), evaluator.get());
    AddToReport(context.GetReport(), evaluator.get());
    context.GetReport()["before"] = DescribeExtent(model, model.GetPositions());
    engine::Scene output = model.MakeScene();
    // One for all, so that they add up as well as the mesh is written.
    Precision const precision = context.ChoosePrecision(a.output, model.GetPositions());
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
        add(NameBand(a.output, static_cast<int>(i)), bands.bands[i]);
    add(a.output + ".remainder.obj", bands.remainder);
    files.Commit();
    context.GetReport()["outputs"] = std::move(outputs);
    context.Warn(warnings);
    return kDone;
}

/// Writes one mesh: a sum of bands.
int WriteSum(BandsArguments const& a, Context& context) {
    if (a.sum.from.empty() && !a.count) throw Error(ErrorCode::BadOption, "--gain needs --count");
    auto options = MakeBandSum(a.sum, a.count, "--count");
    auto const evaluator = MakeEvaluator(a.evaluator, context.GetCommon().precision);
    options.rule = a.rule;
    options.evaluator = evaluator.get();
    std::string const path = NameSum(a.output);
    context.KeepApart({{"MESH", a.mesh}, {"--from", a.sum.from}}, {{"-o", path}});
    auto const model = context.Load(a.mesh);
    if (!a.sum.from.empty()) options.from = context.Load(a.sum.from);
    auto sum = engine::SumBands(model, options, context.GetJob());
    AddToReport(context.GetReport(), a.sum, sum);
    AddToReport(context.GetReport(), evaluator.get());
    context.GetReport()["before"] = DescribeExtent(model, model.GetPositions());
    WriteFiltered(path, model, std::move(sum.positions), context);
    return kDone;
}

}  // namespace

Verb AddBands(CLI::App& app) {
    auto const a = std::make_shared<BandsArguments>();
    CLI::App* const verb = app.add_subcommand(
        "bands", "Split a mesh into frequency bands, or make one mesh of weighed bands");
    verb->add_option("MESH", a->mesh, "OBJ, PLY or OFF")->required();
    verb->add_option("-o,--output", a->output,
                     "PREFIX, without an ending, of PREFIX.band0.obj ... and PREFIX.remainder.obj, "
                     "whose sum is the "
                     "mesh; of one mesh its name, .obj or .ply, else PREFIX.gain.obj")
        ->required();
    AddNumberOption(*verb, "--count", a->count,
                    "number of bands; with --from only needed to give the remainder a --gain",
                    {1, 1000});
    AddBandOptions(*verb, a->sum,
                   "of --from: bands I to J, from 0, I- (with the remainder) or one");
    AddAlpha(*verb, a->rule);
    AddEvaluatorOption(*verb, a->evaluator, "A");
    verb->footer(
        "Example:\n  limn bands scenes/spot/spot.obj -o out/spot --count 4 --precision double");
    return {verb, [a](Context& context) {
                RefuseWithoutFrom(a->sum);
                if (a->sum.from.empty() && !a->sum.bands.empty())
                    throw Error(ErrorCode::BadOption, "--bands needs --from");
                return a->sum.IsSum() ? WriteSum(*a, context) : WriteBands(*a, context);
            }};
}

}  // namespace limn::cli
