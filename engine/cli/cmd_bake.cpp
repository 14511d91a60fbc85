// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <optional>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/bake/audit/audit.h"
#include "engine/bake/bake.h"
#include "engine/bake/group_bakes.h"
#include "engine/bake/left_temporaries.h"
#include "engine/bake/maps/map_table.h"
#include "engine/bake/output_names.h"
#include "engine/bake/pictures/map_picture.h"
#include "engine/cli/cli.h"
#include "engine/cli/names.h"
#include "engine/cli/option_names.h"
#include "engine/cli/options/bake_values.h"
#include "engine/cli/options/band_options.h"
#include "engine/cli/options/choices.h"
#include "engine/cli/options/evaluator_option.h"
#include "engine/cli/options/far_limit_option.h"
#include "engine/cli/options/nearest_words.h"
#include "engine/cli/options/noise_options.h"
#include "engine/cli/options/number_option.h"
#include "engine/cli/options/option_rules.h"
#include "engine/cli/options/word_option.h"
#include "engine/images/exr_names.h"
#include "engine/io/edge_values.h"
#include "engine/io/file.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

struct BakeArguments {
    std::vector<std::string> meshes, tiles, seamBounds;
    std::string size = "2048", against, rest, fieldPath, encode, noiseRamp, previewRange, half;
    std::optional<std::string> origin;
    BandArguments bands;
    bool hasAudit = false, hasPicture = false;
    std::vector<double> view{1.0, 0.6, 0.8};
    engine::AuditBounds bounds;
    engine::BakeOptions options;
    FarLimitArguments far;
};

constexpr NumberRange<double> kAnyBound{.low = 0.0};

/// "0.1", or "mean=0.1" for one map.
engine::AuditBounds ParseBounds(BakeArguments const& a) {
    engine::AuditBounds bounds = a.bounds;
    for (std::string const& text : a.seamBounds) {
        size_t const equals = text.rfind('=');
        double const bound = ParseNumber<double>(
            "--seam-bound", std::string_view(text).substr(equals + 1), kAnyBound);
        if (equals == std::string::npos)
            bounds.seam = bound;
        else
            bounds.seamOfMap[text.substr(0, equals)] = bound;
    }
    engine::CheckBounds(bounds, a.options.maps);
    return bounds;
}

/// The flags that concern single maps, and the members they set.
struct MapFlag {
    char const* flag;
    char const* member;
};
constexpr MapFlag kMapFlags[] = {{"--against", "against"},     {"--rest", "rest"},
                                 {"--bands", "bands"},         {"--origin", "origin"},
                                 {"--vector", "isVector"},     {"--space", "space"},
                                 {"--field", "field"},         {"--normalize", "isNormalized"},
                                 {"--noise-octaves", "noise"}, {"--noise-frequency", "noise"},
                                 {"--noise-gain", "noise"},    {"--noise-seed", "noise"},
                                 {"--noise-at", "noise"},      {"--noise-ramp", "noiseRamp"},
                                 {"--gain", "bandSum"},        {"--from", "bandSum"},
                                 {"--carry", "bandSum"},       {"--evaluator", "evaluator"}};

/// Refuses pictures that cannot be: of what has no colours, or is no file to look up.
void RefusePictures(BakeArguments const& a) {
    if (!a.hasPicture) return;
    if (a.options.space == engine::VectorSpace::UV)
        throw Error(ErrorCode::BadOption,
                    "--picture: a flow in texture coordinates has no colours; --space object has");
    if (engine::GetEnding(a.options.pattern) != ".exr")
        throw Error(ErrorCode::BadOption, "--picture looks maps up in their files; -o names none");
}

void CheckMapNames(std::vector<std::string> const& maps) {
    auto const unknown = std::ranges::find_if_not(maps, engine::IsMapName);
    if (unknown == maps.end()) return;
    throw Error(
        ErrorCode::BadOption,
        fmt::format("--maps: there is no map '{}'; there are: {}{}", *unknown,
                    engine::ListMapNames(), AskForNearest(*unknown, engine::ListFixedMapNames())));
}

/// Refuses flags that would change nothing.
void RefuseWithoutEffect(CLI::App const& verb, std::vector<std::string> const& maps) {
    auto const isBaked = [&](std::string const& map) {
        return std::ranges::find(maps, map) != maps.end();
    };
    for (auto const& [flag, member] : kMapFlags) {
        auto const takers = engine::ListMapsThatTake(member);
        if (member == std::string_view("evaluator") && verb.count("--limit-stencils") > 0)
            continue;  // it applies far's table
        if (verb.count(flag) == 0 || std::ranges::any_of(takers, isBaked)) continue;
        throw Error(ErrorCode::BadOption,
                    fmt::format("{} has no effect on {}; it is for {}", flag, fmt::join(maps, ", "),
                                fmt::join(takers, ", ")));
    }
    if (!isBaked("field")) {
        if (verb.count("--vector") == 0) RefuseEach(verb, {"--space"}, "needs --vector");
        if (verb.count("--noise-ramp"))
            RefuseEach(verb, {"--normalize"}, "has no effect with --noise-ramp");
    }
    if (verb.count("--preview") == 0) {
        RefuseEach(verb, {"--preview-legend"}, "needs --preview");
        if (verb.count("--picture") == 0)
            RefuseEach(verb, {"--preview-range"}, "needs --preview or --picture");
    }
    if (verb.count("--picture") == 0) RefuseEach(verb, {"--view"}, "needs --picture");
    if (verb.count("--audit") == 0)
        RefuseEach(verb, {"--audit-bound", "--seam-bound"}, "needs --audit");
}

/// How many bands, or the one sum of them.
void ChooseBands(BandArguments const& a, engine::BakeOptions& options) {
    RefuseWithoutFrom(a);
    if (a.from.empty() && !a.bands.empty())
        options.bands = ParseNumber<int>("--bands", a.bands, {1, 64});
    if (!a.IsSum()) return;
    std::optional<int> const count = a.from.empty() ? std::optional(options.bands) : std::nullopt;
    options.bandSum = MakeBandSum(a, count, "--bands");
}

engine::BakeOptions MakeOptions(BakeArguments const& a, CommonOptions const& common) {
    engine::BakeOptions options = a.options;
    if (!a.encode.empty()) options.encoding = ParseEncoding(a.encode);
    if (a.origin) options.origin = ParseOrigin(*a.origin);
    if (!a.noiseRamp.empty()) options.noiseRamp = engine::ColourRamp::Parse(a.noiseRamp);
    if (!a.previewRange.empty()) options.previewRange = engine::PreviewRange::Parse(a.previewRange);
    options.isHalf = !a.half.empty();
    options.halfMaps = ParseHalfMaps(a.half, options.maps);
    ChooseBands(a.bands, options);
    auto const [width, height] = ParseTexelSize("--size", a.size, {1, engine::kMaxImageSide});
    options.width = width;
    options.height = height;
    options.tiles = ParseTiles(a.tiles);
    options.orientation = common.orientation;
    options.wantsChecksums = !common.reportPath.empty();
    options.countsSkipped = a.hasAudit;
    return options;
}

void AddToReport(nlohmann::json& report, engine::BakeReport const& bake) {
    auto const add = [&](char const* key, size_t value) {
        report[key] = report.value(key, size_t{0}) + value;
    };
    add("texels_covered", bake.texelsCovered);
    add("overlaps", bake.overlaps);
    add("newton_failures", bake.newtonFailures);
    add("moved_samples", bake.movedSamples);
    add("degenerate_samples", bake.degenerateSamples);
    add("clamped", bake.clamped);
    for (int tile : bake.tiles) report["tiles"].push_back(tile);
    for (int level : bake.singularNoiseLevels) report["noise"]["singular_levels"].push_back(level);
}

/// An output that is complete; so a bake that fails later has told which files stay.
void AddToReport(nlohmann::json& report, engine::BakeOutput const& output,
                 std::string const& mesh) {
    nlohmann::json const sha256 = output.sha256.empty() ? nullptr : nlohmann::json(output.sha256);
    nlohmann::json entry{{"file", output.path},   {"mesh", mesh},
                         {"map", output.map},     {"tile", output.tile},
                         {"width", output.width}, {"height", output.height},
                         {"sha256", sha256},      {"skipped", output.wasSkipped},
                         {"min", output.min},     {"max", output.max}};
    if (output.origin) {
        entry["origin"] = *output.origin;
        if (!report.contains("origin")) report["origin"] = *output.origin;  // the first mesh's
    }
    if (output.isAlongNormal) {
        bool const isKnown = output.leftOut.count > 0;
        entry["tangential_rms"] = isKnown ? nlohmann::json(output.leftOut.GetRms()) : nullptr;
        entry["tangential_max"] = isKnown ? nlohmann::json(output.leftOut.max) : nullptr;
    }
    report["outputs"].push_back(std::move(entry));
    for (std::string const& preview : output.previews) report["previews"].push_back(preview);
}

/// JSON has no "none" for numbers but null.
nlohmann::json OrNull(std::optional<double> const& value) {
    return value ? nlohmann::json(*value) : nlohmann::json();
}

nlohmann::json ToJson(engine::AuditReport const& audit, engine::BakeReport const& bake) {
    nlohmann::json seams = nlohmann::json::array(), components = nlohmann::json::array();
    engine::SeamAudit worst;
    for (auto const& seam : audit.seams) {
        seams.push_back({{"map", seam.map},
                         {"samples", seam.samples},
                         {"max", seam.max},
                         {"p99", seam.p99},
                         {"place", seam.place},
                         {"bound", OrNull(seam.bound)},
                         {"within", seam.bound ? nlohmann::json(seam.isWithin) : nullptr}});
        if (seam.max >= worst.max) worst = seam;
    }
    for (auto const& c : audit.gaussBonnet) {
        components.push_back({{"component", c.component},
                              {"integral", c.integral},
                              {"texel_sum", c.texelSum},
                              {"expected", c.expected},
                              {"relative_error", c.relativeError},
                              {"audited", c.wasAudited},
                              {"reason", NameFlags(c.reason)}});
    }
    return {{"seam_max", worst.max},
            {"seam_p99", worst.p99},
            {"seam_place", worst.place},
            {"seams", seams},
            {"coverage",
             {{"texels", bake.texelsCovered},
              {"overlaps", bake.overlaps},
              {"faces_without_texels", bake.facesWithoutTexels.size()}}},
            {"gauss_bonnet", components}};
}

/// One bake of the run; with the mesh, where making the bake has taken one.
struct Bake {
    std::string mesh;
    std::optional<engine::Model> model;
    engine::BakeOptions options;
};

/// The bakes of a run, none of which is in the way of another, or of what the run reads.
std::vector<Bake> PlanBakes(BakeArguments const& a, engine::BakeOptions const& options,
                            Context& context) {
    std::vector<Bake> bakes;
    engine::OutputNames names;
    for (std::string const& path : a.meshes) {
        std::vector<engine::BakeOptions> ofMesh{options};
        std::optional<engine::Model> model;
        if (engine::HasGroupToken(options.pattern)) {
            model = context.Load(path);
            ofMesh = engine::SplitByGroup(*model, options, context.GetJob());
        }
        for (engine::BakeOptions& own : ofMesh) {
            names.Add(own, std::filesystem::path(path).stem().string(), path);
            bakes.push_back({path, model, std::move(own)});
        }
    }
    for (std::string const& path : a.meshes) names.Refuse(path, "an input");
    for (std::string const& path : {a.against, a.rest, a.fieldPath, a.bands.from}) {
        if (!path.empty()) names.Refuse(path, "an input");
    }
    std::string const& report = context.GetCommon().reportPath;
    if (!report.empty() && report != "-") names.Refuse(report, "the report");
    std::vector<NamedFile> read{{"--against", a.against},
                                {"--rest", a.rest},
                                {"--field", a.fieldPath},
                                {"--from", a.bands.from}};
    for (std::string const& path : a.meshes) read.push_back({"MESH", path});
    context.KeepApart(read, {});  // the report from inputs
    return bakes;
}

/// Draws the pictures of a bake, or takes away those of an earlier one that it has replaced.
void DrawPictures(BakeArguments const& a, engine::Model const& model,
                  engine::BakeOptions const& options, engine::BakeReport const& report,
                  Context& context) {
    if (!a.hasPicture) return engine::RemoveMapPictures(model, options, report);
    engine::PictureView const view{{a.view[0], a.view[1], a.view[2]}};
    auto const paths = engine::WriteMapPictures(model, options, report, view, context.GetJob());
    for (std::string const& path : paths) context.GetReport()["pictures"].push_back(path);
}

/// Compares OpenSubdiv's limit with the one that is baked.
void CompareFar(engine::FarLimitRule const& rule, engine::Model const& model,
                std::string const& mesh, Context& context) {
    engine::PlaceList places;
    engine::AddVertexPlaces(model, places);
    engine::AddFaceCentres(model, places);
    auto json = DescribeFarLimit(engine::CompareFarLimit(
        model, std::move(places), rule, context.GetCommon().orientation, context.GetJob()));
    json["mesh"] = mesh;
    if (!context.GetReport()->contains("far")) context.GetReport()["far"] = json;
    context.GetReport()["fars"].push_back(std::move(json));
}

/// Adds what belongs to the mesh's own bake, bakes, draws, and audits. Returns the bounds missed,
/// in words.
std::vector<std::string> RunBake(BakeArguments const& a, Bake& bake,
                                 engine::AuditBounds const& bounds, Context& context) {
    auto const model = bake.model ? *bake.model : context.Load(bake.mesh);
    engine::BakeOptions& options = bake.options;
    if (!a.fieldPath.empty()) options.field = engine::ReadEdgeValues(a.fieldPath, model.GetLevel());
    if (!a.against.empty()) options.against = context.Load(a.against);
    if (!a.rest.empty()) options.rest = context.Load(a.rest);
    if (!a.bands.from.empty()) options.bandSum->from = context.Load(a.bands.from);
    auto const report = engine::Bake(model, options, context.GetJob());
    AddToReport(context.GetReport(), report);
    DrawPictures(a, model, options, report, context);
    if (auto const rule = a.far.GetRule()) CompareFar(*rule, model, bake.mesh, context);
    if (!a.hasAudit || report.outputs.empty()) return {};
    auto const audit = engine::Audit(model, options, report, bounds, context.GetJob());
    nlohmann::json json = ToJson(audit, report);
    if (!context.GetReport()->contains("audit")) context.GetReport()["audit"] = json;
    json["mesh"] = bake.mesh;
    if (!options.group.empty()) json["group"] = options.group;
    context.GetReport()["audits"].push_back(std::move(json));
    return audit.misses;
}

int Run(BakeArguments const& a, CLI::App const& verb, Context& context) {
    engine::CheckTokens(a.options.pattern);
    engine::RequireExrEnding(a.options.pattern);
    CheckMapNames(a.options.maps);
    RefuseWithoutEffect(verb, a.options.maps);
    RefusePictures(a);
    RefuseWithoutFarLimit(verb, a.far);
    auto const evaluator = MakeEvaluator(a.far.evaluator, context.GetCommon().precision);
    engine::BakeOptions options = MakeOptions(a, context.GetCommon());
    options.evaluator = evaluator.get();
    engine::AuditBounds const bounds = ParseBounds(a);
    if (a.meshes.size() > 1 && a.options.pattern.find("{mesh}") == std::string::npos) {
        throw Error(
            ErrorCode::BadOption,
            fmt::format("-o: several meshes ({}, the last '{}') need {{mesh}} in the output's name",
                        a.meshes.size(), a.meshes.back()));
    }
    std::vector<Bake> bakes = PlanBakes(a, options, context);
    if (a.options.maps.size() > 1 && !engine::HasMapToken(a.options.pattern)) {
        context.GetJob().Warn(
            "the output's name has no {map}: all maps go into one file with a layer each");
    }
    for (char const* list : {"outputs", "previews", "pictures"})
        context.GetReport()[list] = nlohmann::json::array();
    std::vector<std::string> misses, written;
    for (Bake& bake : bakes) {
        bake.options.onOutput = [&](engine::BakeOutput const& output) {
            AddToReport(context.GetReport(), output, bake.mesh);
            if (!output.wasSkipped) written.push_back(output.path);
        };
        auto const own = RunBake(a, bake, bounds, context);
        misses.insert(misses.end(), own.begin(), own.end());
        bake.model.reset();
    }
    AddToReport(context.GetReport(), evaluator.get());
    if (context.GetReport()["outputs"].empty()) {
        throw Error(ErrorCode::BadMesh, "no texel is covered by any group in the tiles asked for");
    }
    std::string const left = engine::DescribeLeftTemporaries(written);
    if (!left.empty()) context.GetJob().Warn(left);
    if (misses.empty()) return kDone;
    for (size_t i = 1; i < misses.size(); ++i) context.GetJob().Warn(misses[i]);
    std::string const more =
        misses.size() > 1 ? fmt::format(" ({} more, see the warnings)", misses.size() - 1) : "";
    return context.MissTarget(NameFlags(misses[0]) + more + "; the files stay");
}

/// What the files hold.
void AddFileOptions(CLI::App& verb, BakeArguments& a) {
    verb.add_option("--size", a.size, "texels: N or WxH (default 2048); 4k is 4096");
    verb.add_option("--tiles", a.tiles,
                    "UDIM tiles, e.g. 1001,1003-1005 (default all, if at most 100)")
        ->delimiter(',');
    AddNumberOption(verb, "--samples", a.options.samplesPerSide,
                    "N x N samples per texel (default 1)", {1, 16});
    AddNumberOption(verb, "--padding", a.options.padding,
                    "texels grown round the charts (default 16)", {0, 4096});
    verb.add_flag("--half{" + std::string(kAllMaps) + "}", a.half,
                  "16-bit floats (default 32-bit); --half=normal,mean: of these maps only");
    AddWordOption(verb, "--compression", a.options.compression, engine::kExrCompressionWords,
                  "of the EXR (default zip)");
    verb.add_flag("--mip", a.options.hasMips, "mip levels, for renderers");
    verb.add_flag("--coverage", a.options.hasCoverage, "add a channel 'coverage'");
    verb.add_flag("--preview", a.options.hasPreview,
                  "also a PNG to look at, a pixel per texel, padding included");
    verb.add_flag(
        "--preview-legend", a.options.hasPreviewLegend,
        "and beside it NAME.legend.png: map, mesh, unit, and which colour is which value");
    verb.add_option(
        "--preview-range", a.previewRange,
        "of previews and pictures: A,B; p1 (1st to 99th percentile, the default of scalars); full; "
        "asinh "
        "(linear up to the median, logarithmic beyond); signed maps are 0 in the middle");
    verb.add_flag("--picture", a.hasPicture,
                  "also NAME.picture.png per map: the limit surface with the baked map on it");
    AddNumberOption(verb, "--view", a.view,
                    "of pictures: the side that is seen, x,y,z (default 1,0.6,0.8)")
        ->delimiter(',')
        ->expected(3);
    verb.add_option("--encode", a.encode, "S,O: write value * S + O");
}

/// What single maps need.
void AddMapOptions(CLI::App& verb, BakeArguments& a) {
    verb.add_option("--against", a.against, "the mesh that displacement leads to");
    verb.add_option("--rest", a.rest, "of the map tension: the mesh before it was posed");
    verb.add_option("--origin", a.origin,
                    "X,Y,Z taken off the map position, or auto: a round point near the mesh's "
                    "middle; header limn:origin");
    AddBandOptions(verb, a.bands,
                   "of the map bands: frequency bands, their smooth base included (default 4, at "
                   "most 64); with --from which of that mesh's, from 0: I-J, I- (with the "
                   "remainder) or one",
                   std::to_string(a.options.bands));
    verb.add_flag(
        "--vector", a.options.isVector,
        "displacement and bands as whole vectors (default: only their part along the "
        "normal; the report has tangential_rms and tangential_max, what that leaves out)");
    AddWordOption(verb, "--space", a.options.space, kVectorSpaceWords,
                  "object (default) or tangent, of vectors; uv: of the map field, flow in "
                  "texture coordinates");
    verb.add_option(
        "--field", a.fieldPath,
        "CSV v0,v1,value of MESH's edges, for the map field (limn field -o x.edges.csv)");
}

/// What a renderer has to know to show the maps right.
constexpr char const* kConventions =
    "Conventions:\n"
    "  Texture coordinates are subdivided, too, by the rule --fvar: the file's, else "
    "corners-plus1,\n"
    "  which Blender calls \"Keep Corners, Junctions\". A renderer that uses another rule shows "
    "the\n"
    "  maps displaced. v = 0 is the lower edge of the picture.\n"
    "  Tangent space is (T, n x T, n): x along T, the direction in which u grows, laid into the\n"
    "  tangent plane; y along n x T, z along the normal n; all of length 1, not packed into 0 to "
    "1.\n"
    "  Displacement is in units of the mesh, 0 where nothing moves: point + value * n, or with\n"
    "  --vector point + vector, in the axes of --space. --encode S,O writes value * S + O.\n\n";

}  // namespace

Verb AddBake(CLI::App& app) {
    auto const a = std::make_shared<BakeArguments>();
    CLI::App* const verb =
        app.add_subcommand("bake", "Bake maps of the limit surface into textures");
    verb->add_option("MESH", a->meshes, "OBJ, PLY or OFF; several with {mesh} in the output's name")
        ->required();
    verb->add_option("-o,--output", a->options.pattern,
                     "output path, .exr, with {map}, {mesh}, {group} (a bake per group), <UDIM> or "
                     "{udim}; also <udim>, %(UDIM)d, <UVTILE> (u1_v1), <uvtile> (u0_v0)")
        ->required();
    verb->add_option("--maps", a->options.maps,
                     "one or more of these, or of primvar:NAME (values of the mesh), with commas "
                     "between them")
        ->type_name(JoinChoices(engine::ListFixedMapNames()))
        ->delimiter(',')
        ->required();
    AddFileOptions(*verb, *a);
    AddMapOptions(*verb, *a);
    AddNoiseOptions(*verb, a->options.noise, a->noiseRamp);
    verb->add_flag("--normalize", a->options.isNormalized,
                   "noise from 0 to 1 over the whole surface; fields of length 1");
    verb->add_flag("--audit", a->hasAudit,
                   "check seams, coverage and Gauss-Bonnet, and report them");
    AddNumberOption(*verb, "--audit-bound", a->bounds.gaussBonnet,
                    "of the Gauss-Bonnet error (default 1e-3); missed: exit status 4", kAnyBound);
    verb->add_option("--seam-bound", a->seamBounds,
                     "X or MAP=X: of the largest difference along seams, in map units (default: "
                     "not judged); several with commas between them, or repeated")
        ->delimiter(',')
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    AddEvaluatorOption(*verb, a->far.evaluator, "tables of noise, field and bands, or far's,");
    AddFarLimitOptions(*verb, a->far, "at vertices and face centres, beside the exact texels");
    verb->add_option("--groups", a->options.groups, "only faces of these usemtl, g or o groups")
        ->delimiter(',');
    verb->add_flag("--skip-existing", a->options.skipsExisting,
                   "leave files of the same input, options and version alone");
    verb->footer(std::string(kConventions) +
                 "Example:\n  limn bake scenes/spot/spot.obj -o 'out/spot.{map}.<UDIM>.exr' --maps "
                 "mean,normal --size 2048 "
                 "--preview");
    return {verb, [a, verb](Context& context) { return Run(*a, *verb, context); }};
}

}  // namespace limn::cli
