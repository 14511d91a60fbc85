// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "engine/cli/cli.h"
#include "engine/cli/names.h"
#include "engine/cli/options/evaluator_option.h"
#include "engine/cli/options/number_option.h"
#include "engine/cli/options/option_rules.h"
#include "engine/cli/options/word_option.h"
#include "engine/images/png.h"
#include "engine/io/file.h"
#include "engine/io/matrix_market.h"
#include "engine/io/mesh_writer.h"
#include "engine/measure/mesh_picture.h"
#include "engine/scene/subdivision_names.h"
#include "engine/smooth/smooth.h"
#include "far_ext/error.h"
#include "far_ext/topology/boundary.h"

namespace limn::cli {

namespace {

struct SmoothArguments {
    std::string mesh, output, widthMap, widthEdges, widthTexture, picture, stencils;
    std::vector<double> view{1.0, 0.6, 0.8};
    double width = 0.0, widthFactor = engine::kDefaultWidthFactor,
           widthScale = engine::kDefaultWidthFactor;
    std::optional<double> tolerance;
    std::optional<int> sweeps, iterations, steps;
    std::optional<std::string> keptFeatures;
    bool isLocal = false, isGraph = false, preservesVolume = false, limitsWidth = false,
         keepsResult = false;
    std::optional<eval::EvaluatorKind> evaluator;
    engine::SmoothOptions options;

    bool IsBisection() const { return options.refinement == engine::SmoothRefinement::Bisect; }
};

void CheckWidths(SmoothArguments const& a, CLI::App const& verb) {
    RefuseTogether(verb, {"--width", "--width-factor"});
    RefuseTogether(verb, {"--local", "--width-map", "--width-edges", "--width-texture"});
    for (char const* other : {"--local", "--width-map", "--width-edges"}) {
        for (char const* flag : {"--width", "--width-factor"}) RefuseTogether(verb, {other, flag});
    }
    if (!a.isLocal) RefuseEach(verb, {"--width-scale"}, "needs --local");
}

void CheckSolver(SmoothArguments const& a, CLI::App const& verb) {
    RefuseTogether(verb, {"--sweeps", "--iterations", "--tolerance"});
    using Solver = eval::CascadeSolver;
    Solver const solver = a.options.solver;
    if (solver != Solver::ConjugateGradients) {
        RefuseEach(verb, {"--tolerance"},
                   fmt::format("is for --solver cg, not {}", kCascadeSolverWords.GetWord(solver)));
    }
    if (solver == Solver::Exact)
        RefuseEach(verb, {"--sweeps", "--iterations"},
                   "means nothing to --solver exact; leave it out");
}

void CheckOptions(SmoothArguments const& a, CLI::App const& verb) {
    engine::RequireMeshEnding(a.output);
    RequirePngEnding("--picture", a.picture);
    if (!a.stencils.empty()) RequirePrefix("--write-stencils", a.stencils);
    CheckWidths(a, verb);
    CheckSolver(a, verb);
    RefuseTogether(verb, {"--graph", "--preserve-volume"});
    RefuseTogether(verb, {"--limit-width", "--keep-result"});
    if (a.options.adaptive) {
        if (verb.count("--refinement") > 0 && !a.IsBisection())
            throw Error(ErrorCode::BadOption,
                        "--refinement quadrisect and --adaptive exclude each other");
        return;
    }
    int const maxLevels = a.IsBisection() ? 20 : 10;
    if (a.options.levels > maxLevels) {
        throw Error(
            ErrorCode::BadOption,
            fmt::format("--levels: {} is not from 0 to {} with --refinement {}", a.options.levels,
                        maxLevels, kSmoothRefinementWords.GetWord(a.options.refinement)));
    }
}

/// LAMBDA, or LAMBDA% of 1 / mean edge.
std::optional<double> ParseKeptFeatures(SmoothArguments const& a, double meanEdge) {
    if (!a.keptFeatures) return std::nullopt;
    bool const isShare = a.keptFeatures->ends_with('%');
    double const number =
        ParseNumber("--keep-features", a.keptFeatures->substr(0, a.keptFeatures->size() - isShare),
                    NumberRange<double>{.low = 1e-12});
    return isShare ? number / (100.0 * meanEdge) : number;
}

engine::SmoothStop MakeStop(SmoothArguments const& a) {
    if (a.iterations) return engine::IterationsPerLevel{*a.iterations};
    if (a.sweeps) return engine::SweepsOnFinest{*a.sweeps};
    if (a.options.solver == eval::CascadeSolver::Jacobi)
        return engine::SweepsOnFinest{1};  // as [Diewald02] always does
    return a.tolerance ? engine::StopAtResidual{*a.tolerance} : engine::StopAtResidual{};
}

/// \param meanEdge   of the mesh
/// \param evaluator  null: none
engine::SmoothOptions MakeOptions(SmoothArguments const& a, CLI::App const& verb,
                                  Context const& context, double meanEdge,
                                  eval::TableEvaluator* evaluator) {
    engine::SmoothOptions options = a.options;
    options.stop = MakeStop(a);
    if (options.adaptive && verb.count("--levels") == 0) options.levels = 8;
    options.keptFeatures = ParseKeptFeatures(a, meanEdge);
    options.steps = a.steps.value_or(options.keptFeatures ? 3 : 1);
    if (a.isGraph) options.constraint = engine::SmoothConstraint::Graph;
    if (a.preservesVolume) options.constraint = engine::SmoothConstraint::Volume;
    if (a.limitsWidth) options.onCollapse = engine::OnCollapse::LimitWidth;
    if (a.keepsResult) options.onCollapse = engine::OnCollapse::KeepResult;
    options.precision = context.GetCommon().GetPrecision();
    options.target = context.MakeTarget(a.output);
    options.evaluator = evaluator;
    options.keepsSweeps = !a.stencils.empty();
    return options;
}

engine::FilterWidths MakeWidths(SmoothArguments const& a, CLI::App const& verb,
                                engine::Model const& model) {
    double const width =
        verb.count("--width")
            ? a.width
            : a.widthFactor * far_ext::FindMeanEdgeLength(model.GetLevel(), model.GetPositions());
    if (a.isLocal) return engine::MakeLocalWidths(model, a.widthScale);
    if (!a.widthMap.empty()) return engine::ReadVertexWidths(a.widthMap, model);
    if (!a.widthEdges.empty()) return engine::EdgeWidths::Read(a.widthEdges, model);
    if (!a.widthTexture.empty()) return engine::PaintedWidths::Read(a.widthTexture, width, model);
    return engine::ConstantWidth{width};
}

void AddToReport(nlohmann::json& report, engine::SmoothReport const& found,
                 engine::SmoothOptions const& options) {
    auto const number = [](double value) {
        return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
    };
    auto& levels = report["levels"] = nlohmann::json::array();
    for (auto const& level : found.levels) {
        levels.push_back({{"level", level.level},
                          {"unknowns", level.unknowns},
                          {"sweeps", level.sweeps},
                          {"residual", number(level.residual)},
                          {"converged", level.converged},
                          {"min_angle_degrees", level.minAngleRadians * 180.0 / std::numbers::pi},
                          {"area_ratio", level.areaRatio},
                          {"frozen_metric", level.isMetricFrozen}});
        if (found.levels.back().step > 1) levels.back()["step"] = level.step;
    }
    if (found.adaption) {
        report["adaptive"] = {{"asked", *options.adaptive},
                              {"estimated", found.adaption->estimated},
                              {"passes", found.adaption->passes},
                              {"vertices", found.adaption->vertices},
                              {"smallest_edge", found.adaption->smallestEdge},
                              {"uniform_vertices", found.adaption->uniformVertices},
                              {"settle_moves", found.settleMoves}};
    } else if (!found.settleMoves.empty()) {
        report["settle_moves"] = found.settleMoves;
    }
    report["converged"] = found.HasConverged();
    report["mean_edge"] = found.meanEdge;
    report["largest_width"] = found.largestWidth;
    if (found.limitedBy) report["width_limited_by"] = *found.limitedBy;
    if (found.shrinkage) {
        report["shrinkage"] = {{"first_vertex", found.shrinkage->firstVertex},
                               {"level", found.shrinkage->level},
                               {"radius_ratio", found.shrinkage->radiusRatio}};
    }
    if (found.criticalFactor) {
        report["critical_factor"] = *found.criticalFactor;
        report["critical_width"] = found.GetCriticalWidth();
    }
    for (auto const& volume : found.volumes) {
        report["volumes"].push_back({{"first_vertex", volume.firstVertex},
                                     {"start", volume.start},
                                     {"end", volume.end},
                                     {"kept", volume.isMet}});
    }
}

/// What went wrong, and what helps, in one line.
std::string Explain(std::string const& path, engine::SmoothReport const& found) {
    if (found.hasCollapsed) {
        auto const& [vertex, level, ratio] = *found.shrinkage;
        return fmt::format(
            "{}: a filter of width {:.4g} collapses the component of vertex {} (mean radius {:.2g} "
            "of its own on level {}); measured on a coarser mesh it "
            "carries {:.4g}. Use less, --limit-width or --preserve-volume",
            path, found.largestWidth, vertex, ratio, level, found.GetCriticalWidth());
    }
    auto const& missed = *std::find_if(found.levels.begin(), found.levels.end(),
                                       [](auto const& level) { return !level.converged; });
    return fmt::format(
        "{}: on level {} the residual is {:.2g} after {} iterations; use a larger --tolerance or "
        "--solver exact",
        path, missed.level, missed.residual, missed.sweeps);
}

std::string NameMatrix(std::string const& prefix, int level, char const* which) {
    return fmt::format("{}.{}.{}.mtx", prefix, level, which);
}

/// What will be written; two files a level of --write-stencils.
std::vector<NamedFile> ListOutputs(SmoothArguments const& a) {
    std::vector<NamedFile> files{{"-o", a.output}, {"--picture", a.picture}};
    if (a.stencils.empty()) return files;
    for (int level = std::min(1, a.options.levels); level <= a.options.levels; ++level) {
        for (char const* which : {"sweep", "load"})
            files.push_back({"--write-stencils", NameMatrix(a.stencils, level, which)});
    }
    return files;
}

void AddSweeps(std::string const& prefix, std::vector<engine::LevelSweep> const& sweeps,
               engine::MeshSequence& files) {
    for (auto const& [level, matrices] : sweeps) {
        auto const add = [&](char const* which, far_ext::SparseRows const& rows,
                             std::string const& columns) {
            engine::WriteMatrixMarket(files.Open(NameMatrix(prefix, level, which)),
                                      far_ext::AsMatrix(rows, rows.GetNumRows()),
                                      {fmt::format("vertices of level {}", level), columns});
        };
        add("sweep", matrices.sweep, "the same, before a sweep");
        add("load", matrices.load, "the same, of the start surface");
    }
}

/// What --adaptive puts in the place of options that nobody gave.
void DescribeAdaptive(nlohmann::json& effective, engine::SmoothOptions const& options) {
    effective["levels"] = options.levels;
    effective["refinement"] = kSmoothRefinementWords.GetWord(engine::SmoothRefinement::Bisect);
}

int Run(SmoothArguments const& a, CLI::App const& verb, Context& context) {
    CheckOptions(a, verb);
    auto const evaluator = MakeEvaluator(a.evaluator, context.GetCommon().precision);
    engine::CheckOptions(MakeOptions(a, verb, context, 1.0, evaluator.get()));
    context.KeepApart({{"MESH", a.mesh},
                       {"--width-map", a.widthMap},
                       {"--width-edges", a.widthEdges},
                       {"--width-texture", a.widthTexture}},
                      ListOutputs(a));
    auto model = context.Load(a.mesh,
                              Context::Defects::Keep);  // engine::Smooth warns of them, or refuses
    if (!context.GetCommon().scheme || a.IsBisection() || a.options.adaptive)
        model = WithScheme(model, engine::ChooseCascadeScheme(model.GetCage()));
    context.GetReport()["inputs"].back()["subdivision"] =
        engine::DescribeSubdivision(model.GetCage());
    double const meanEdge = far_ext::FindMeanEdgeLength(model.GetLevel(), model.GetPositions());
    engine::SmoothOptions const options = MakeOptions(a, verb, context, meanEdge, evaluator.get());
    if (options.adaptive) DescribeAdaptive(context.GetReport()["effective_options"], options);
    auto [mesh, found, sweeps] =
        engine::Smooth(model, MakeWidths(a, verb, model), options, context.GetJob());
    AddToReport(context.GetReport(), found, a.options);
    AddToReport(context.GetReport(), evaluator.get());
    if (!found.HasConverged() && !a.keepsResult) return context.MissTarget(Explain(a.mesh, found));

    if (engine::GetEnding(a.output) == ".obj")  // which has no place for the widths
        std::erase_if(mesh->primvars, [](auto const& primvar) { return primvar.name == "width"; });
    engine::MeshSequence files;
    context.GetJob().Start("writing " + a.output);
    auto const warnings = files.Add(a.output, *mesh, found.precision);
    AddSweeps(a.stencils, sweeps, files);
    if (!a.picture.empty()) {
        context.GetJob().Start("drawing " + a.picture);
        engine::WritePng(files.Open(a.picture),
                         engine::DrawShaded(*mesh, {{a.view[0], a.view[1], a.view[2]}}));
    }
    files.Commit();
    context.Warn(warnings);
    context.GetReport()["precision_written"] = kPrecisionWords.GetWord(found.precision);
    context.GetReport()["vertices"] = mesh->cage.numVertices;
    context.GetReport()["faces"] = mesh->cage.GetNumFaces();
    return found.HasConverged() ? kDone : context.MissTarget(Explain(a.mesh, found));
}

constexpr NumberRange<double> kAnyWidth{.low = 0.0};

void AddWidthOptions(CLI::App& verb, SmoothArguments& a) {
    auto const width = [](CLI::Option* option) {
        return option->group("Width of the filter (one of these)");
    };
    width(AddNumberOption(verb, "--width", a.width, "sigma everywhere, in mesh units", kAnyWidth));
    width(AddNumberOption(verb, "--width-factor", a.widthFactor,
                          "sigma everywhere, times the mean edge length (default 0.12; limn info "
                          "--widths tells how much MESH carries)",
                          kAnyWidth));
    width(verb.add_flag("--local", a.isLocal,
                        "sigma by the edge lengths at each vertex, smoothed along"));
    width(AddNumberOption(verb, "--width-scale", a.widthScale,
                          "--local: times the edge length (default 0.12)", kAnyWidth));
    width(verb.add_option("--width-map", a.widthMap, "CSV vertex,width: 0 where not listed"));
    width(verb.add_option("--width-edges", a.widthEdges,
                          "CSV v0,v1,width: rounds these edges, and leaves faces untouched"));
    width(verb.add_option(
        "--width-texture", a.widthTexture,
        "image through the texture coordinates, 0 to 1 times --width or --width-factor"));
}

void AddSolverOptions(CLI::App& verb, SmoothArguments& a) {
    auto const solve = [](CLI::Option* option) { return option->group("Solving"); };
    solve(AddWordOption(verb, "--refinement", a.options.refinement, kSmoothRefinementWords,
                        "quadrisect (default): triangles in four, other faces into quads "
                        "(--scheme catmark: triangles, too); bisect: triangles in two"));
    solve(AddWordOption(verb, "--solver", a.options.solver, kCascadeSolverWords,
                        "cg (default), jacobi or exact"));
    solve(AddNumberOption(
        verb, "--sweeps", a.sweeps,
        "on the finest level, more on coarser ones by the a-priori rule (jacobi: default 1)",
        {1, 1000000}));
    solve(AddNumberOption(verb, "--iterations", a.iterations, "the same number on every level",
                          {1, 1000000}));
    solve(AddNumberOption(verb, "--tolerance", a.tolerance,
                          "cg: to this residual on every level (default 1e-6)", {1e-14, 1.0}));
    solve(AddEvaluatorOption(verb, a.evaluator, "interpolation and sweeps of --solver jacobi"));
    solve(verb.add_option("--write-stencils", a.stencils,
                          "jacobi: each level K's sweep as matrices, PREFIX.K.sweep.mtx and "
                          "PREFIX.K.load.mtx")
              ->type_name("PREFIX"));
    solve(AddNumberOption(verb, "--adaptive", a.options.adaptive,
                          "cut triangles (in two) only where the result would be off by more than "
                          "this share of MESH's diagonal, and settle to a fifth of it",
                          {1e-9, 1.0}));
    solve(
        AddNumberOption(verb, "--steps", a.steps,
                        "so many filters one after another, of sigma / sqrt(steps) each; from the "
                        "second on on the finest mesh (default 1, --keep-features: 3)",
                        {1, 1000}));
    solve(AddNumberOption(verb, "--settle", a.options.settle,
                          "then repeat, until no vertex moves by this share of MESH's diagonal",
                          {1e-14, 1.0}));
}

void AddConstraintOptions(CLI::App& verb, SmoothArguments& a) {
    auto const keep = [](CLI::Option* option) { return option->group("What stays"); };
    keep(AddWordOption(verb, "--boundary-rule", a.options.boundary, kBoundaryRuleWords,
                       "fixed (default); natural: free, its triangles degenerate with the levels"));
    keep(verb.add_flag("--keep-creases", a.options.keepsCreases,
                       "sharp edges and corners stay sharp: the filter does not act across them"));
    keep(AddNumberOption(verb, "--order", a.options.order,
                         "2 (default); 4, with --levels 0: loses less volume", {2, 4}));
    keep(
        verb.add_option("--keep-features", a.keptFeatures,
                        "LAMBDA or LAMBDA%, with --levels 0: do not act where normals turn by more "
                        "than that over a length (% of 1 / mean edge; 10 to 20% for scans)")
            ->type_name("LAMBDA"));
    keep(verb.add_flag("--preserve-volume", a.preservesVolume,
                       "closed components keep their volume"));
    keep(verb.add_flag("--graph", a.isGraph,
                       "MESH is a height field: z over the plane of x and y, which stay"));
    keep(verb.add_flag("--limit-width", a.limitsWidth,
                       "reduce a width that collapses the shape to what it carries"));
    keep(verb.add_flag("--keep-result", a.keepsResult,
                       "write what collapsed or missed its tolerance"));
}

}  // namespace

Verb AddSmooth(CLI::App& app) {
    auto const a = std::make_shared<SmoothArguments>();
    CLI::App* const verb =
        app.add_subcommand("smooth", "Refine a mesh and smooth it by curvature motion, to a width");
    verb->add_option("MESH", a->mesh, "OBJ, PLY or OFF")->required();
    verb->add_option("-o,--output", a->output,
                     "mesh to write, .obj, or .ply with the width at each vertex")
        ->required();
    AddNumberOption(*verb, "--levels", a->options.levels,
                    "refinements (default 2, with --adaptive at most 8); 0: MESH as it is, of "
                    "triangles or of quads, is filtered",
                    {0, 20});
    AddWidthOptions(*verb, *a);
    AddSolverOptions(*verb, *a);
    AddConstraintOptions(*verb, *a);
    auto* const picture =
        verb->add_option("--picture", a->picture, "also write a PNG: the result, flat shaded");
    AddNumberOption(*verb, "--view", a->view,
                    "the picture's side that is seen, x,y,z (default 1,0.6,0.8)")
        ->delimiter(',')
        ->expected(3)
        ->needs(picture);
    verb->footer(
        "Example:\n  limn smooth scenes/spot/spot.obj -o out/spot.smooth.obj --levels 2 "
        "--width-factor 0.3");
    return {verb, [a, verb](Context& context) { return Run(*a, *verb, context); }};
}

}  // namespace limn::cli
