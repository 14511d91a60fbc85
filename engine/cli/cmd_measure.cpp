// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "engine/cli/cli.h"
#include "engine/cli/names.h"
#include "engine/cli/options/choices.h"
#include "engine/cli/options/number_option.h"
#include "engine/cli/options/option_rules.h"
#include "engine/cli/options/word_flag.h"
#include "engine/cli/options/word_option.h"
#include "engine/images/png.h"
#include "engine/io/mesh_writer.h"
#include "engine/measure/measure.h"
#include "engine/measure/mesh_picture.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

struct MeasureArguments {
    std::string mesh, prefix, range, picture;
    engine::MeasuredSurface surface = engine::MeasuredSurface::Limit;
    std::vector<double> view{1.0, 0.6, 0.8};
    bool hasHighlight = false;

    bool HasPicture() const { return !picture.empty(); }
};

engine::MapTraits const kMean{.name = "mean", .units = "1/length"},
    kGaussian{.name = "gaussian", .units = "1/length^2"};

/// Which curvature the picture shows. A flag without a word is "true".
engine::MapTraits const& ChooseCurvature(std::string const& picture) {
    if (picture.empty() || picture == "true" || picture == kMean.name) return kMean;
    if (picture == kGaussian.name) return kGaussian;
    RefuseChoice("--picture", picture, {kMean.name, kGaussian.name});
}

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
    if (a.prefix.empty() && (a.hasHighlight || a.HasPicture())) {
        throw Error(ErrorCode::BadOption,
                    "--highlight and --picture write files; name their beginning with -o");
    }
    if (!a.HasPicture() && !a.range.empty())
        throw Error(ErrorCode::BadOption, "--preview-range needs --picture");
    auto const& pictured = ChooseCurvature(a.picture);
    std::string const picturePath = fmt::format("{}.{}.png", a.prefix, pictured.name);
    std::optional<engine::PreviewRange> range;
    if (!a.range.empty()) range = engine::PreviewRange::Parse(a.range);
    if (!a.hasHighlight && !a.HasPicture())
        RefuseEach(verb, {"--view"}, "needs --highlight or --picture");
    std::vector<NamedFile> written;
    if (!a.prefix.empty()) written.push_back({"-o", a.prefix + ".ply"});
    if (a.HasPicture()) written.push_back({"--picture", picturePath});
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
        if (a.HasPicture())
            engine::WritePng(files.Open(picturePath),
                             engine::DrawValues(curved, pictured, view, range));
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
    AddWordFlag(*verb, "--picture", a->picture, {kMean.name, kGaussian.name},
                "also write PREFIX.mean.png: the mesh in colours of mean curvature; with gaussian "
                "behind it PREFIX.gaussian.png, of Gaussian curvature");
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
