// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "engine/cli/cli.h"
#include "engine/cli/names.h"
#include "engine/cli/options/word_option.h"
#include "engine/evaluate/evaluate.h"
#include "engine/evaluate/field_values.h"
#include "engine/evaluate/frames.h"
#include "engine/evaluate/place_table.h"
#include "engine/io/atomic_file.h"
#include "engine/io/edge_values.h"

namespace limn::cli {

namespace {

struct EvalArguments {
    std::string mesh, places, output, frames, field;
    std::optional<eval::EvaluatorKind> evaluator;
};

void EvaluateFrames(EvalArguments const& a, engine::Model const& model,
                    engine::PlaceTable const& places, Context& context) {
    CommonOptions const& common = context.GetCommon();
    engine::FrameOptions const options{a.output, common.orientation, common.precision, a.evaluator};
    auto const frames = engine::FindFrames(a.frames);
    auto const result = engine::NamingRows(places, [&] {
        return engine::EvaluateFrames(model, places.GetPlaces(), frames, options, context.GetJob());
    });
    auto const report = context.GetReport();
    report["places_without_limit"] = result.numWithoutLimit;
    report["places_in_table"] = result.numRows;
    report["evaluator"] = a.evaluator ? GetName(*a.evaluator) : "double";
    report["frames"] = result.outputs.size();
    report["outputs"] = result.outputs;
    report["precision_written"] = kPrecisionWords.GetWord(result.precision);
}

int Run(EvalArguments const& a, Context& context) {
    CommonOptions const& common = context.GetCommon();
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
        EvaluateFrames(a, model, places, context);
        return kDone;
    }
    auto const values = engine::NamingRows(places, [&] {
        return engine::EvaluateLimit(model, places.GetPlaces(), common.orientation,
                                     context.GetJob());
    });
    context.GetReport()["places_without_limit"] = values.CountWithoutLimit();
    std::vector<double> field;
    if (!a.field.empty())
        field = engine::EvaluateField(
            model, places.GetPlaces(), engine::ReadEdgeValues(a.field, model.GetLevel()),
            engine::ChooseFieldLevels(model), context.GetJob());
    context.GetJob().Start("writing " + (a.output.empty() ? "stdout" : a.output));
    Precision const precision = common.precision.value_or(enough);
    context.GetReport()["precision_written"] = kPrecisionWords.GetWord(precision);
    std::string const text = engine::FormatValues(places.GetPlaces(), values, precision, field);
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
    auto* const frames =
        verb->add_option(
                "--frames", a->frames,
                "the same places in every frame: a folder of meshes, or a file name with {frame}; "
                "MESH gives topology and tags")
            ->needs(output);
    verb->add_option("--field", a->field,
                     "CSV v0,v1,value: a field along edges of MESH; columns fx,fy,fz have its "
                     "limit's vectors")
        ->excludes(frames);
    AddWordOption(*verb, "--evaluator", a->evaluator, eval::kEvaluatorWords,
                  "apply the frames' table in float: simd (limn's), osd-cpu or osd-omp "
                  "(OpenSubdiv's); default: in double")
        ->needs(frames);
    verb->footer(
        "Example:\n  printf 'face,s,t\\n0,0.5,0.5\\n' > places.csv\n  limn eval "
        "scenes/spot/spot.obj --at places.csv\n"
        "  limn eval walk.0001.obj --at places.csv --frames 'walk.{frame}.obj' -o "
        "'walk.{frame}.csv'");
    return {verb, [a](Context& context) { return Run(*a, context); }};
}

}  // namespace limn::cli
