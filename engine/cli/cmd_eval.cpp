// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "engine/cli/cli.h"
#include "engine/cli/names.h"
#include "engine/cli/options/evaluator_option.h"
#include "engine/cli/options/far_limit_option.h"
#include "engine/cli/options/noise_options.h"
#include "engine/cli/options/option_rules.h"
#include "engine/evaluate/evaluate.h"
#include "engine/evaluate/frames.h"
#include "engine/evaluate/place_table.h"
#include "engine/io/atomic_file.h"
#include "engine/io/edge_values.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

struct EvalArguments {
    std::string mesh, places, output, frames, field, noiseRamp;
    FarLimitArguments far;
    engine::PlaceMapOptions maps;
};

/// What --maps says; a field is also asked for by its file.
std::vector<std::string> ListMaps(EvalArguments const& a) {
    std::vector<std::string> maps = a.maps.maps;
    bool const isNamed = std::ranges::find(maps, "field") != maps.end();
    if (!a.field.empty() && !isNamed) maps.emplace_back("field");
    return maps;
}

/// Refuses options of maps that are not asked for.
void CheckMapOptions(EvalArguments const& a, CLI::App const& verb) {
    auto const maps = ListMaps(a);
    auto const has = [&](char const* map) { return std::ranges::find(maps, map) != maps.end(); };
    for (char const* flag : {"--maps", "--field"}) RefuseTogether(verb, {flag, "--frames"});
    if (has("field") && a.field.empty())
        throw Error(ErrorCode::BadOption, "--maps field needs --field");
    if (!has("noise")) RefuseEach(verb, kNoiseFlags, "needs --maps noise");
    if (!has("noise") && !has("field"))
        RefuseEach(verb, {"--normalize"}, "needs --maps noise or --field");
    if (!has("field") && !a.noiseRamp.empty())
        RefuseEach(verb, {"--normalize"}, "has no effect with --noise-ramp");
}

/// The columns of maps.
std::vector<engine::PlaceColumn> EvaluateMaps(EvalArguments const& a, engine::Model const& model,
                                              engine::PlaceTable const& places, Context& context) {
    engine::PlaceMapOptions options = a.maps;
    options.maps = ListMaps(a);
    if (options.maps.empty()) return {};
    if (!a.noiseRamp.empty()) options.noiseRamp = engine::ColourRamp::Parse(a.noiseRamp);
    if (!a.field.empty()) options.field = engine::ReadEdgeValues(a.field, model.GetLevel());
    auto result = engine::NamingRows(places, [&] {
        return engine::EvaluateMaps(model, places.GetPlaces(), options, context.GetJob());
    });
    if (std::ranges::find(options.maps, "noise") != options.maps.end())
        context.GetReport()["noise"] = {{"singular_levels", result.singularLevels}};
    return std::move(result.columns);
}

void EvaluateFrames(EvalArguments const& a, engine::Model const& model,
                    engine::PlaceTable const& places, eval::TableEvaluator* evaluator,
                    Context& context) {
    CommonOptions const& common = context.GetCommon();
    engine::FrameOptions const options{a.output, common.orientation, common.precision, evaluator};
    auto const frames = engine::FindFrames(a.frames);
    auto const result = engine::NamingRows(places, [&] {
        return engine::EvaluateFrames(model, places.GetPlaces(), frames, options, context.GetJob());
    });
    auto const report = context.GetReport();
    report["places_without_limit"] = result.numWithoutLimit;
    report["places_in_table"] = result.numRows;
    if (!evaluator) report["evaluator"] = "double";
    report["frames"] = result.outputs.size();
    report["outputs"] = result.outputs;
    report["precision_written"] = kPrecisionWords.GetWord(result.precision);
}

/// The limit at the places, or OpenSubdiv's, which is compared with it.
engine::LimitValues Evaluate(EvalArguments const& a, engine::Model const& model,
                             engine::PlaceTable const& places, eval::TableEvaluator* evaluator,
                             Context& context) {
    Orientation const orientation = context.GetCommon().orientation;
    auto const rule = a.far.GetRule();
    if (!rule && evaluator) {
        return engine::EvaluateLimit(model, places.GetPlaces(), orientation, *evaluator,
                                     context.GetJob());
    }
    if (!rule)
        return engine::EvaluateLimit(model, places.GetPlaces(), orientation, context.GetJob());
    auto report = engine::CompareFarLimit(model, {places.faces, places.s, places.t}, *rule,
                                          orientation, context.GetJob());
    context.GetReport()["far"] = DescribeFarLimit(report);
    return std::move(report.far.values);
}

void CheckOptions(EvalArguments const& a, CLI::App const& verb) {
    RefuseWithoutFarLimit(verb, a.far);
    if (a.far.stencils == LimitStencils::Far)
        RefuseTogether(verb, {"--limit-stencils", "--frames"});
}

int Run(EvalArguments const& a, CLI::App const& verb, Context& context) {
    CheckOptions(a, verb);
    CheckMapOptions(a, verb);
    CommonOptions const& common = context.GetCommon();
    auto const evaluator = MakeEvaluator(a.far.evaluator, common.precision);
    context.KeepStdoutForData(a.output.empty());
    context.KeepApart({{"MESH", a.mesh}, {"--at", a.places}, {"--field", a.field}},
                      {{"-o", a.output}});
    auto const model = context.Load(a.mesh);
    engine::Extent const extent = engine::FindExtent(model.GetPositions());
    Precision const enough = engine::FindTablePrecision(extent);
    if (common.precision == Precision::Float && enough == Precision::Double) {
        context.GetJob().Warn(
            fmt::format("{}: coordinates of 9 digits are {:g} apart, of a mesh of size {:.4g}; "
                        "without --precision there are 17",
                        a.mesh, engine::GetTableStep(extent), extent.GetDiagonal()));
    }
    context.GetJob().Start("reading " + a.places);
    auto const places = engine::ReadPlaces(a.places);
    context.GetReport()["places"] = places.faces.size();
    if (!a.frames.empty()) {
        EvaluateFrames(a, model, places, evaluator.get(), context);
        AddToReport(context.GetReport(), evaluator.get());
        return kDone;
    }
    auto const values = engine::NamingRows(
        places, [&] { return Evaluate(a, model, places, evaluator.get(), context); });
    auto const columns = EvaluateMaps(a, model, places, context);
    AddToReport(context.GetReport(), evaluator.get());
    context.GetReport()["places_without_limit"] = values.CountWithoutLimit();
    context.GetJob().Start("writing " + (a.output.empty() ? "stdout" : a.output));
    Precision const precision = common.precision.value_or(enough);
    context.GetReport()["precision_written"] = kPrecisionWords.GetWord(precision);
    std::string const text = engine::FormatValues(places.GetPlaces(), values, precision, columns);
    if (a.output.empty())
        PrintData(text);
    else
        engine::WriteFileAtomically(a.output, text);
    return kDone;
}

}  // namespace

Verb AddEval(CLI::App& app) {
    auto const a = std::make_shared<EvalArguments>();
    CLI::App* const verb =
        app.add_subcommand("eval", "Evaluate the limit surface at listed places, in double");
    verb->add_option("MESH", a->mesh, "OBJ, PLY or OFF")->required();
    verb->add_option("--at", a->places, "CSV with the columns face,s,t")->required();
    auto* const output =
        verb->add_option("-o,--output", a->output,
                         "CSV to write (default stdout); with --frames a name with {frame}");
    verb->add_option(
            "--frames", a->frames,
            "the same places in every frame: a folder of meshes, or a file name with {frame}; "
            "MESH gives topology and tags")
        ->needs(output);
    AddEvaluatorOption(*verb, a->far.evaluator, "the table of places, or far's,");
    AddFarLimitOptions(*verb, a->far, "in place of the limit");
    verb->add_option("--maps", a->maps.maps,
                     "further columns: noise, field (fx,fy,fz), primvar:NAME, as a bake has them; "
                     "with commas between them")
        ->delimiter(',')
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    verb->add_option("--field", a->field, "CSV v0,v1,value of MESH's edges: the columns fx,fy,fz");
    AddNoiseOptions(*verb, a->maps.noise, a->noiseRamp);
    verb->add_flag("--normalize", a->maps.isNormalized,
                   "noise from 0 to 1 over the whole surface; fields of length 1");
    verb->footer(
        "Example:\n  printf 'face,s,t\\n0,0.5,0.5\\n' > places.csv\n  limn eval "
        "scenes/spot/spot.obj --at places.csv\n"
        "  limn eval walk.0001.obj --at places.csv --frames 'walk.{frame}.obj' -o "
        "'walk.{frame}.csv'");
    return {verb, [a, verb](Context& context) { return Run(*a, *verb, context); }};
}

}  // namespace limn::cli
