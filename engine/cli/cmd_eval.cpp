// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "engine/cli/cli.h"
#include "engine/cli/word_option.h"
#include "engine/evaluate/evaluate.h"
#include "engine/evaluate/frames.h"
#include "engine/io/file.h"

namespace limn::cli {

namespace {

struct EvalArguments {
    std::string mesh, places, output, frames;
    std::optional<eval::EvaluatorKind> evaluator;
};

void EvaluateFrames(EvalArguments const& a, engine::Scene const& scene,
                    Far::TopologyRefiner const& refiner, engine::PlaceList const& places,
                    Context& context) {
    CommonOptions const& common = context.GetCommon();
    engine::FrameOptions const options{a.output, common.IsLeftHanded(), common.IsDouble(),
                                       a.evaluator};
    auto const result = engine::EvaluateFrames(
        scene, refiner, places, a.places, engine::FindFrames(a.frames), options, context.GetJob());
    auto& report = context.GetReport();
    report["places_without_limit"] = result.numWithoutLimit;
    report["places_in_table"] = result.numRows;
    report["evaluator"] = a.evaluator ? GetName(*a.evaluator) : "double";
    report["frames"] = result.outputs.size();
    report["outputs"] = result.outputs;
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
    AddWordOption(*verb, "--evaluator", a->evaluator, eval::kEvaluatorWords,
                  "apply the frames' table in float: simd (limn's), osd-cpu or osd-omp "
                  "(OpenSubdiv's); default: in double")
        ->needs(frames);
    verb->footer(
        "Example:\n  printf 'face,s,t\\n0,0.5,0.5\\n' > places.csv\n  limn eval "
        "scenes/spot/spot.obj --at places.csv\n"
        "  limn eval walk.0001.obj --at places.csv --frames 'walk.{frame}.obj' -o "
        "'walk.{frame}.csv'");
    return {verb, [a](Context& context) {
                context.KeepStdoutForData(a->output.empty());
                auto const [scene, refiner] = context.Load(a->mesh);
                auto const places = engine::ReadPlaces(a->places);
                context.GetReport()["places"] = places.faces.size();
                if (!a->frames.empty()) {
                    EvaluateFrames(*a, scene, *refiner, places, context);
                    return kDone;
                }
                size_t numWithout = 0;
                std::string const text = engine::EvaluatePlaces(
                    scene, *refiner, places, a->places, context.GetCommon().IsLeftHanded(),
                    context.GetCommon().IsDouble(), numWithout);
                context.GetReport()["places_without_limit"] = numWithout;
                if (a->output.empty())
                    PrintData(text);
                else
                    engine::WriteFileAtomically(a->output, text);
                return kDone;
            }};
}

}  // namespace limn::cli
