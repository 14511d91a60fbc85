// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "engine/cli/cli.h"
#include "engine/cli/names.h"
#include "engine/cli/options/number_option.h"
#include "engine/cli/options/option_rules.h"
#include "engine/cli/options/word_option.h"
#include "engine/images/png.h"
#include "engine/io/mesh_writer.h"
#include "engine/measure/measure.h"
#include "engine/measure/mesh_picture.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

struct MeasureArguments {
    std::string mesh, prefix, range;
    engine::MeasuredSurface surface = engine::MeasuredSurface::Limit;
    std::vector<double> view{1.0, 0.6, 0.8};
    bool hasHighlight = false, hasPicture = false;
};

engine::MapTraits const kMean{.name = "mean", .units = "1/length"};

nlohmann::json ToJson(engine::CurvatureStatistics const& statistics) {
    return {{"min", statistics.min},
            {"max", statistics.max},
            {"mean", statistics.mean},
            {"stddev", statistics.stddev}};
}

nlohmann::json ToJson(engine::Measurement const& found) {
    nlohmann::json json{{"area", found.area},
                        {"volume", nullptr},
                        {"euler_characteristic", found.eulerCharacteristic},
                        {"thin_plate_energy", found.energy.mean},
                        {"thin_plate_energy_area", found.energy.integral},
                        {"mean_curvature", ToJson(found.mean)},
                        {"gaussian_curvature", ToJson(found.gaussian)},
                        {"samples", found.numSamples},
                        {"gauss_bonnet", nlohmann::json::array()}};
    if (found.volume) json["volume"] = *found.volume;
    for (auto const& audit : found.gaussBonnet) {
        json["gauss_bonnet"].push_back({{"component", audit.component},
                                        {"integral", audit.integral},
                                        {"expected", audit.expected},
                                        {"relative_error", audit.relativeError},
                                        {"audited", audit.wasAudited},
                                        {"reason", audit.reason}});
    }
    return json;
}

int RunMeasure(MeasureArguments const& a, CLI::App const& verb, Context& context) {
    context.KeepStdoutForData(true);
    RequirePrefix("-o", a.prefix);
    if (a.prefix.empty() && (a.hasHighlight || a.hasPicture)) {
        throw Error(ErrorCode::BadOption,
                    "--highlight and --picture write files; name their beginning with -o");
    }
    if (!a.hasPicture && !a.range.empty())
        throw Error(ErrorCode::BadOption, "--preview-range needs --picture");
    std::optional<engine::PreviewRange> range;
    if (!a.range.empty()) range = engine::PreviewRange::Parse(a.range);
    if (!a.hasHighlight && !a.hasPicture)
        RefuseEach(verb, {"--view"}, "needs --highlight or --picture");
    std::vector<NamedFile> written;
    if (!a.prefix.empty()) written.push_back({"-o", a.prefix + ".ply"});
    if (a.hasPicture) written.push_back({"--picture", a.prefix + ".mean.png"});
    if (a.hasHighlight) written.push_back({"--highlight", a.prefix + ".highlight.png"});
    context.KeepApart({{"MESH", a.mesh}}, written);
    auto const model = context.Load(a.mesh);
    CommonOptions const& common = context.GetCommon();
    engine::Job& job = context.GetJob();
    auto const json = ToJson(engine::Measure(model, a.surface, common.orientation, job));
    engine::MeshSequence files;
    if (!a.prefix.empty()) {
        auto const curved = engine::AddVertexCurvature(
            model, engine::FindVertexCurvature(model, a.surface, common.orientation, job));
        std::string const path = a.prefix + ".ply";
        job.Start("writing " + path);
        Precision const precision = context.ChoosePrecision(path, curved.positions);
        context.Warn(files.Add(path, curved, precision));
        context.GetReport()["precision_written"] = kPrecisionWords.GetWord(precision);
        job.Start("drawing pictures");
        engine::PictureView const view{{a.view[0], a.view[1], a.view[2]}};
        if (a.hasPicture)
            engine::WritePng(files.Open(a.prefix + ".mean.png"),
                             engine::DrawValues(curved, kMean, view, range));
        if (a.hasHighlight)
            engine::WritePng(files.Open(a.prefix + ".highlight.png"),
                             engine::DrawHighlights(curved, view));
    }
    PrintData(json.dump(2) + "\n");
    files.Commit();
    context.GetReport()->update(json);
    return kDone;
}

}  // namespace

Verb AddMeasure(CLI::App& app) {
    auto const a = std::make_shared<MeasureArguments>();
    CLI::App* const verb =
        app.add_subcommand("measure", "Area, volume, energies and curvature of a surface");
    verb->add_option("MESH", a->mesh, "OBJ, PLY or OFF")->required();
    verb->add_option("-o,--output", a->prefix,
                     "write PREFIX.ply with mean, gaussian, k1 and k2 per vertex");
    AddWordOption(*verb, "--surface", a->surface, kMeasuredSurfaceWords,
                  "limit (default): exact curvature of the limit; mesh: of the mesh itself");
    verb->add_flag("--highlight", a->hasHighlight,
                   "also write PREFIX.highlight.png: highlight lines of the mesh");
    verb->add_flag("--picture", a->hasPicture,
                   "also write PREFIX.mean.png: the mesh in colours of mean curvature");
    verb->add_option("--preview-range", a->range,
                     "colours of the picture: A,B, p1 (default: 1st to 99th percentile of what is "
                     "seen), full or asinh");
    AddNumberOption(*verb, "--view", a->view,
                    "pictures: the side that is seen, x,y,z (default 1,0.6,0.8)")
        ->delimiter(',')
        ->expected(3);
    verb->footer("Example:\n  limn measure scenes/spot/spot.obj -o out/spot --highlight");
    return {verb, [a, verb](Context& context) { return RunMeasure(*a, *verb, context); }};
}

}  // namespace limn::cli
