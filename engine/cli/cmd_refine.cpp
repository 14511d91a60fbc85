// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "engine/cli/cli.h"
#include "engine/cli/names.h"
#include "engine/cli/options/evaluator_option.h"
#include "engine/cli/options/noise_options.h"
#include "engine/cli/options/number_option.h"
#include "engine/cli/options/option_rules.h"
#include "engine/cli/options/word_option.h"
#include "engine/differential/curves.h"
#include "engine/differential/differential.h"
#include "engine/differential/edit_reader.h"
#include "engine/differential/polyline_file.h"
#include "engine/io/file.h"
#include "engine/io/mesh_writer.h"
#include "engine/noise/noise_scale.h"
#include "engine/noise/surface_noise.h"
#include "engine/scene/refine.h"
#include "engine/scene/subdivision_names.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

using far_ext::SubdivisionRule;

/// Options that only meshes in differential space have.
std::vector<char const*> const kDifferentialOptions{
    "--laplacian", "--dirmag", "--spatial-first", "--handle",
    "--solver",    "--edit",   "--tolerance",     "--keep-result"};

struct RefineArguments {
    std::string mesh, output, editPath;
    std::optional<NamedRule> rule;
    std::optional<double> tolerance, tension;
    int levels = 1;
    bool isDifferential = false, toLimit = false, keepsResult = false, isCurve = false;
    double alpha = 0.0;
    engine::DifferentialOptions options;
    bool hasNoise = false, isNoiseNormalized = false;
    engine::NoiseOptions noise;
    std::string noiseRamp;
    std::optional<eval::EvaluatorKind> evaluator;
};

/// Refuses a mesh with other faces than the rule can have.
void RequireSize(engine::Model const& model, NamedRule const& rule, int size,
                 char const* whatItTakes) {
    auto const& sizes = model.GetCage().faceSizes;
    auto const other = std::ranges::find_if(sizes, [size](int found) { return found != size; });
    if (other == sizes.end()) return;
    throw Error(ErrorCode::BadMesh,
                fmt::format("{}: {} has {} corners; --rule {} takes {}", model.GetPath(),
                            model.NameFace(static_cast<Index>(other - sizes.begin())), *other,
                            kRuleWords.GetWord(rule), whatItTakes));
}

void RequireFaces(engine::Model const& model, NamedRule const& rule) {
    if (rule.scheme == Sdc::SCHEME_LOOP)
        RequireSize(model, rule, 3, "triangles only, --rule catmark all");
    if (rule.rule == SubdivisionRule::Kobbelt)
        RequireSize(model, rule, 4, "quads only; make them by one level of --rule catmark first");
}

/// The mesh under the scheme that the rule asks for, where one is named.
engine::Model ApplyRule(RefineArguments const& a, CommonOptions const& common,
                        engine::Model const& model) {
    if (!a.rule) return model;
    if (common.scheme && a.rule->scheme != model.GetCage().scheme) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("--rule {} contradicts --scheme {}", kRuleWords.GetWord(*a.rule),
                                engine::kSchemeWords.GetWord(*common.scheme)));
    }
    RequireFaces(model, *a.rule);
    return WithScheme(model, a.rule->scheme);
}

far_ext::TunedRule GetRule(RefineArguments const& a) {
    return {a.rule ? a.rule->rule : SubdivisionRule::Scheme, a.tension};
}

bool IsFit(engine::DifferentialOptions const& options) {
    return options.laplacian != engine::Laplacian::Combinatorial;
}

/// The tolerance that decides.
double& GetTolerance(engine::DifferentialOptions& options) {
    return IsFit(options) ? options.fitTolerance : options.tolerance;
}

engine::DifferentialOptions MakeOptions(RefineArguments const& a, CommonOptions const& common) {
    engine::DifferentialOptions options = a.options;
    options.levels = a.levels;
    options.rule = GetRule(a);
    // What is written should be right to its last digits.
    options.tolerance = common.GetPrecision() == Precision::Double ? 1e-12 : 1e-8;
    if (a.tolerance) GetTolerance(options) = *a.tolerance;
    options.orientation = common.orientation;
    if (!a.editPath.empty()) options.edit = engine::ReadCurvatureEdit(a.editPath);
    return options;
}

nlohmann::json ToJson(std::vector<engine::EditOutcome> const& edits) {
    auto list = nlohmann::json::array();
    for (auto const& [target, reached] : edits) {
        bool const isMean = std::holds_alternative<double>(target.asked);
        auto& entry = list.emplace_back(nlohmann::json{
            {"vertex", target.vertex}, {"kind", isMean ? "mean" : "normal"}, {"reached", nullptr}});
        std::visit([&](auto const& asked) { entry["asked"] = asked; }, target.asked);
        if (reached) entry["reached"] = *reached;
    }
    return list;
}

/// Why the tolerance was missed, and what became of the result.
std::string Explain(engine::DifferentialReport const& found, bool isFit, double tolerance,
                    bool isKept) {
    char const* const then =
        isKept ? "the result is kept" : "nothing is written without --keep-result";
    if (!isFit) {
        return fmt::format(
            "the solver stopped at residual {:.1e} after {} iterations; the tolerance is {:.1e}; "
            "{}",
            found.residual, found.iterations, tolerance, then);
    }
    return fmt::format(
        "{:.2g} of the differential coordinates remains unmet after {} steps{}; --tolerance is "
        "{:.2g}; {}",
        found.residual, found.fitSteps, found.hasFitStalled ? ", and more would gain little" : "",
        tolerance, then);
}

engine::DifferentialResult RefineDifferentially(RefineArguments const& a,
                                                engine::Model const& model,
                                                eval::TableEvaluator* evaluator, Context& context) {
    auto options = MakeOptions(a, context.GetCommon());
    options.evaluator = evaluator;
    options.target = context.MakeTarget(a.output);
    auto result = engine::RefineDifferentially(model, options, context.GetJob());
    engine::DifferentialReport const& found = result.report;
    auto const report = context.GetReport();
    report["unknowns"] = found.unknowns;
    report["iterations"] = found.iterations;
    report["solve_seconds"] = found.seconds.reconstruction;
    report["stages"] = {{"coordinates", found.seconds.coordinates},
                        {"subdivision", found.seconds.subdivision},
                        {"reconstruction", found.seconds.reconstruction}};
    report["residual"] = found.residual;
    report["compatibility_defect"] = found.compatibilityDefect;
    report["residual_rounding"] = found.rounding;
    report["converged"] = found.converged;
    if (IsFit(options)) {
        report["fit_steps"] = found.fitSteps;
        report["fit_stalled"] = found.hasFitStalled;
    }
    report["tangential_share"] = found.tangentialShare;
    report["size_ratio"] = found.sizeRatio;
    report["thin_plate_energy"] = found.energy.mean;
    report["thin_plate_energy_area"] = found.energy.integral;
    if (!a.editPath.empty()) report["edits"] = ToJson(found.edits);
    if (!found.converged) {
        context.MissTarget(
            fmt::format("{}: {}", a.mesh,
                        Explain(found, IsFit(options), GetTolerance(options), a.keepsResult)));
    }
    return result;
}

void CheckNoise(RefineArguments const& a, CLI::App const& verb) {
    if (!a.hasNoise) {
        RefuseEach(verb, kNoiseFlags, "needs --noise");
        return RefuseEach(verb, {"--normalize"}, "needs --noise");
    }
    RefuseTogether(verb, {"--noise-ramp", "--normalize"});
    if (a.noiseRamp.empty() && engine::GetEnding(a.output) != ".ply") {
        throw Error(ErrorCode::BadOption,
                    "--noise: an OBJ holds no scalars; write a .ply, or colours by --noise-ramp");
    }
}

/// Gives a refined mesh the noise of the model's limit surface at its vertices: a scalar, or
/// colours, in place of such as there are.
void AddNoise(RefineArguments const& a, engine::Model const& model, engine::Scene& mesh,
              eval::TableEvaluator* evaluator, Context& context) {
    context.GetJob().Start("making noise");
    engine::NoiseOptions options = a.noise;
    options.evaluator = evaluator;
    auto const noise = engine::FindVertexNoise(model, options, a.levels, context.GetJob());
    context.GetReport()["noise"] = {{"singular_levels", noise.singularLevels}};
    std::optional<engine::ColourRamp> ramp;
    if (!a.noiseRamp.empty()) ramp = engine::ColourRamp::Parse(a.noiseRamp);
    engine::NoiseScale const scale(noise.low, noise.high, a.isNoiseNormalized, ramp);
    engine::Primvar primvar{ramp ? "color" : "noise", scale.GetNumChannels(), {}};
    std::vector<double> channels(static_cast<size_t>(scale.GetNumChannels()));
    for (double value : noise.values) {
        scale.Convert(value, channels);
        for (double channel : channels) primvar.values.push_back(static_cast<float>(channel));
    }
    std::erase_if(mesh.primvars, [&](auto const& known) { return known.name == primvar.name; });
    mesh.primvars.push_back(std::move(primvar));
}

void CheckSpace(RefineArguments const& a, CLI::App const& verb) {
    if (a.isDifferential) RefuseEach(verb, {"--alpha"}, "is of --space spatial");
    if (!a.isDifferential)
        return RefuseEach(verb, kDifferentialOptions, "needs --space differential");
    if (a.toLimit) {
        throw Error(ErrorCode::BadOption,
                    "--limit: the limit of --space differential has no closed form; leave it out");
    }
}

/// Polylines by the rule that boundaries follow: cubic B-spline, or four-point where the rule
/// interpolates.
int RefineCurves(RefineArguments const& a, CLI::App const& verb, Context& context) {
    constexpr char const* kWhy = "means nothing with --curve; leave it out";
    RefuseEach(verb, kDifferentialOptions, kWhy);
    RefuseEach(verb, {"--limit", "--weld", "--tension", "--alpha", "--noise", "--evaluator"}, kWhy);
    auto const rule =
        GetRule(a).IsInterpolating() ? eval::CurveRule::FourPoint : eval::CurveRule::CubicBSpline;
    context.GetJob().Start("reading " + a.mesh);
    auto const [curves, sha256] = engine::ReadPolylines(a.mesh);
    auto const start = std::chrono::steady_clock::now();
    auto const [fine, worst] =
        engine::RefineCurves(curves, {rule, a.levels, a.isDifferential}, context.GetJob());
    std::chrono::duration<double> const elapsed = std::chrono::steady_clock::now() - start;
    size_t numPoints = 0;
    for (eval::Curve const& curve : fine) numPoints += curve.points.size();
    context.GetJob().Start("writing " + a.output);
    Precision const precision = context.ChoosePrecision(a.output, engine::ListCoordinates(fine));
    engine::WritePolylines(a.output, fine, precision);
    auto const report = context.GetReport();
    report["precision_written"] = kPrecisionWords.GetWord(precision);
    report["inputs"].push_back({{"path", a.mesh}, {"sha256", sha256}, {"curves", curves.size()}});
    report["vertices"] = report["unknowns"] = numPoints;
    report["solve_seconds"] = elapsed.count();
    report["residual"] = worst.residual;
    report["compatibility_defect"] = worst.compatibilityDefect;
    return kDone;
}

int RunRefine(RefineArguments const& a, CLI::App const& verb, Context& context) {
    context.KeepApart({{"MESH", a.mesh}, {"--edit", a.editPath}}, {{"-o", a.output}});
    CheckNoise(a, verb);
    if (a.isCurve) return RefineCurves(a, verb, context);
    CheckSpace(a, verb);
    far_ext::CheckTension(GetRule(a));
    auto const evaluator = MakeEvaluator(a.evaluator, context.GetCommon().precision);
    auto const model = ApplyRule(a, context.GetCommon(), context.Load(a.mesh));
    context.GetReport()["inputs"].back()["subdivision"] =
        engine::DescribeSubdivision(model.GetCage());
    engine::DifferentialResult result;
    result.report.converged = true;
    if (a.isDifferential) {
        result = RefineDifferentially(a, model, evaluator.get(), context);
    } else {
        result.mesh = engine::RefineUniformly(model,
                                              {.levels = a.levels,
                                               .toLimit = a.toLimit,
                                               .rule = GetRule(a),
                                               .alpha = a.alpha,
                                               .evaluator = evaluator.get()},
                                              context.GetJob());
        result.report.precision = context.ChoosePrecision(a.output, result.mesh.positions);
    }
    if (a.hasNoise) AddNoise(a, model, result.mesh, evaluator.get(), context);
    AddToReport(context.GetReport(), evaluator.get());
    bool const isDone = result.report.converged;
    if (isDone || a.keepsResult) context.WriteMesh(a.output, result.mesh, result.report.precision);
    context.GetReport()["vertices"] = result.mesh.cage.numVertices;
    context.GetReport()["faces"] = result.mesh.cage.GetNumFaces();
    return isDone ? kDone : kNotReached;
}

void AddDifferentialOptions(CLI::App& verb, RefineArguments& a) {
    auto const differential = [](CLI::Option* option) {
        return option->group("Options of --space differential");
    };
    differential(AddWordOption(verb, "--laplacian", a.options.laplacian, kLaplacianWords,
                               "combinatorial (default), cotangent or mesh"));
    differential(AddNumberOption(verb, "--dirmag", a.options.dirMagLevels,
                                 "first levels done by direction and magnitude (default 0)",
                                 {0, 10}));
    differential(AddNumberOption(verb, "--spatial-first", a.options.spatialLevels,
                                 "levels done in space before (default 0)", {0, 10}));
    differential(
        AddNumberOption(verb, "--handle", a.options.handles,
                        "vertex that stays: one per component or boundary loop (repeatable)"));
    differential(AddWordOption(verb, "--solver", a.options.solver, kDifferentialSolverWords,
                               "multigrid (default) or cholesky"));
    differential(verb.add_option(
        "--edit", a.editPath,
        "JSON, all keys optional, vertices 0-based: {\"set_curvature\": [{\"vertex\": 3, "
        "\"mean\": 0.2}], \"curvature\": [{\"vertex\": 4, \"factor\": 1.5}], \"set_normal\": "
        "[{\"vertex\": 5, \"normal\": [0,1,1]}], \"rotate\": [{\"vertex\": 7, \"axis\": [0,0,1], "
        "\"degrees\": 20}], \"filter\": \"polarise\" or {\"points\": [[0,0], [0.5,0.2], [1,1]]}}; "
        "applied in this order"));
    differential(AddNumberOption(
        verb, "--tolerance", a.tolerance,
        "of what remains of the differential coordinates, over their length (default "
        "1e-8, with --precision double 1e-12; with --laplacian cotangent or mesh 0.01)",
        {1e-15, 1.0}));
    differential(verb.add_flag("--keep-result", a.keepsResult,
                               "write what a solver that missed its tolerance has"));
}

}  // namespace

Verb AddRefine(CLI::App& app) {
    auto const a = std::make_shared<RefineArguments>();
    CLI::App* const verb = app.add_subcommand("refine", "Subdivide a mesh");
    verb->add_option("MESH", a->mesh, "OBJ, PLY or OFF")->required();
    verb->add_option("-o,--output", a->output, "mesh to write, .obj or .ply")->required();
    AddNumberOption(*verb, "--levels", a->levels, "how often (default 1)", {0, 10});
    AddWordOption(*verb, "--space", a->isDifferential, kIsDifferentialWords,
                  "spatial (default): rules on positions; differential: on mean-curvature normals");
    AddWordOption(*verb, "--rule", a->rule, kRuleWords,
                  "default: the scheme's; loop and catmark approximate, the others keep vertices: "
                  "butterfly (modified), butterfly-original and kobbelt (quads) with a --tension, "
                  "interpolating-loop and interpolating-catmark deduced from those two");
    AddNumberOption(*verb, "--tension", a->tension,
                    "of butterfly-original from 0 to 0.125 (default 0.0625), of kobbelt from 0 to "
                    "2 (default 1)",
                    {0.0, 2.0});
    verb->add_flag("--limit", a->toLimit, "move the result's vertices to the limit surface");
    AddNumberOption(*verb, "--alpha", a->alpha,
                    "generalised Catmull-Clark in every step, 0 (default) to 1: the surface of "
                    "limn fit --alpha-rule stationary",
                    {0.0, 1.0});
    AddEvaluatorOption(*verb, a->evaluator, "the rules of each level and, of --limit, A");
    verb->add_flag("--noise", a->hasNoise,
                   "add noise on the limit surface as a scalar 'noise' (.ply) or, with "
                   "--noise-ramp, as colours");
    AddNoiseOptions(*verb, a->noise, a->noiseRamp);
    verb->add_flag("--normalize", a->isNoiseNormalized, "noise from 0 to 1 over the whole surface");
    verb->add_flag("--curve", a->isCurve,
                   "MESH holds polylines (OBJ 'l'); their rule is cubic B-spline, or four-point "
                   "where --rule keeps vertices");
    AddDifferentialOptions(*verb, *a);
    verb->footer(
        "Example:\n  limn refine scenes/spot/spot.obj -o out/spot.2.obj --levels 2 --space "
        "differential");
    return {verb, [a, verb](Context& context) { return RunRefine(*a, *verb, context); }};
}

}  // namespace limn::cli
