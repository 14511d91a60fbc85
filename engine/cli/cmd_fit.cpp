// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>

#include "engine/cli/filter_options.h"
#include "engine/cli/options/far_limit_option.h"
#include "engine/cli/options/option_rules.h"
#include "engine/fit/fit.h"
#include "engine/io/matrix_market.h"
#include "engine/io/mesh_writer.h"
#include "engine/scene/refine.h"
#include "far_ext/error.h"
#include "far_ext/limit/limit_matrix.h"

namespace limn::cli {

namespace {

struct FitArguments {
    std::string mesh, output, matrix;
    engine::FitOptions options;
    int level = 0;
    bool keepsResult = false;
    FarLimitArguments far;
};

nlohmann::json ToJson(std::vector<eval::SingularReport> const& components) {
    nlohmann::json list = nlohmann::json::array();
    for (auto const& component : components) {
        list.push_back({{"first_vertex", component.firstVertex},
                        {"vertices", component.numVertices},
                        {"defect", component.defect},
                        {"solved", component.isSolved}});
    }
    return list;
}

void AddToReport(nlohmann::json& report, engine::FitResult const& result) {
    auto const& solve = result.report;
    report["method"] = GetName(solve.method);
    report["iterations"] = solve.iterations;
    report["residual"] = solve.residual;
    report["residual_history"] = solve.history;
    report["converged"] = result.HasConverged();
    report["lambda_min"] = result.lambdaMin;
    report["singular_components"] = ToJson(solve.singularComponents);
    report["certificate"] = {{"max", result.certificate.max},
                             {"rms", result.certificate.rms},
                             {"worst_vertex", result.certificate.worstVertex}};
    if (result.far) report["far"] = DescribeFarLimit(*result.far);
    report["solve_seconds"] = result.solveSeconds;
    for (size_t i = 0; i < result.primvars.size(); ++i) {
        auto const& primvar = result.primvars[i];
        report["primvars"].push_back({{"name", result.mesh.primvars[i].name},
                                      {"iterations", primvar.iterations},
                                      {"residual", primvar.residual},
                                      {"converged", primvar.converged}});
    }
}

constexpr char const* kSingular =
    "is closed, all its vertices have valence 3 and alternate (like a cube's), so that A is "
    "singular";

/// Tells of components that were solved by minimum norm.
void WarnOfSingular(Context& context, std::string const& path,
                    std::vector<eval::SingularReport> const& components) {
    size_t numSolved = 0;
    eval::SingularReport const* first = nullptr;
    for (auto const& component : components) {
        if (!component.isSolved) continue;
        ++numSolved;
        if (!first) first = &component;
    }
    if (!first) return;
    std::string const others =
        numSolved > 1 ? fmt::format(", and so for {} more", numSolved - 1) : "";
    context.GetJob().Warn(fmt::format(
        "{}: the component of vertex {} ({} vertices) {}; it got the solution of minimum norm{}",
        path, first->firstVertex, first->numVertices, kSingular, others));
}

/// What exceeds a bound, with as many digits as tell the two apart.
std::string ShowBeyond(double value, double bound) {
    std::string text;
    for (int digits = 2; digits <= 17; ++digits) {
        text = fmt::format("{:.{}g}", value, digits);
        if (text != fmt::format("{:.{}g}", bound, digits)) break;
    }
    return text;
}

/// Why the tolerance was missed, and what helps, in one line.
std::string Explain(std::string const& path, engine::FitResult const& result, double tolerance) {
    for (auto const& component : result.report.singularComponents) {
        if (component.isSolved) continue;
        return fmt::format(
            "{}: the component of vertex {} ({} vertices) {}, and its vertices are {} of the "
            "diagonal off what a limit "
            "surface can reach (tolerance {:g}); use --alpha 0.5",
            path, component.firstVertex, component.numVertices, kSingular,
            ShowBeyond(component.defect, tolerance), tolerance);
    }
    if (result.HasRunAway()) {
        return fmt::format(
            "{}: A has no inverse, as far as doubles tell: the control mesh runs away, {:.2g} "
            "times as far as the vertices, and its limit misses them by {:.2g} of the diagonal; "
            "use --alpha 0.5",
            path, result.growth, result.certificate.max);
    }
    for (size_t i = 0; i < result.primvars.size(); ++i) {
        if (result.report.converged && !result.primvars[i].converged) {
            return fmt::format(
                "{}: the primvar '{}' missed the tolerance {:g}: {} after {} applications of A",
                path, result.mesh.primvars[i].name, tolerance,
                ShowBeyond(result.primvars[i].residual, tolerance), result.primvars[i].iterations);
        }
    }
    if (result.report.converged) {
        return fmt::format(
            "{}: the limit of the result, its coordinates rounded to {}, misses vertex {} by "
            "{} of the diagonal; the tolerance is {:g}{}",
            path, kPrecisionWords.GetWord(result.precision), result.certificate.worstVertex,
            ShowBeyond(result.certificate.max, tolerance), tolerance,
            result.precision == Precision::Float ? "; use --precision double" : "");
    }
    return fmt::format(
        "{}: the residual is {} of the diagonal after {} applications of A, worst at vertex "
        "{}; the tolerance is {:g} and "
        "A's smallest eigenvalue about {:.2g}; use --max-iterations, --method direct or --alpha "
        "0.5",
        path, ShowBeyond(result.report.residual, tolerance), result.report.iterations,
        result.report.worstVertex, tolerance, result.lambdaMin);
}

/// The mesh and, where wanted, A.
void Write(FitArguments const& a, engine::Model const& model, engine::FitResult const& result,
           Context& context) {
    context.GetJob().Start("writing " + a.output);
    engine::MeshSequence files;
    auto const warnings = files.Add(a.output, result.mesh, result.precision);
    context.GetReport()["precision_written"] = kPrecisionWords.GetWord(result.precision);
    if (!a.matrix.empty()) {
        auto const A =
            far_ext::LimitMatrix::Build(model.GetRefiner(), 0, {.alpha = a.options.alpha});
        engine::WriteMatrixMarket(files.Open(a.matrix), A.AsMatrix(),
                                  {"limit points of vertices", "vertices"});
    }
    files.Commit();
    context.Warn(warnings);
}

int Run(FitArguments const& a, CLI::App const& verb, Context& context) {
    engine::FitOptions options = a.options;
    options.target = context.MakeTarget(a.output);
    options.farLimit = a.far.GetRule();
    auto const evaluator = MakeEvaluator(a.far.evaluator, context.GetCommon().precision);
    options.evaluator = evaluator.get();
    RefuseWithoutFarLimit(verb, a.far);
    engine::RequireMeshEnding(a.output);
    if (options.method == eval::SolveMethod::Direct)
        RefuseEach(verb, {"--max-iterations"}, "has no effect with --method direct");
    bool const isStationary = options.alphaRule == far_ext::LimitOptions::AlphaRule::Stationary;
    if (options.keepsTopology && (options.alpha == 0.0 || isStationary)) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("--keep-topology: {} the topology is kept anyway",
                                isStationary ? "with --alpha-rule stationary" : "without --alpha"));
    }
    if (!a.matrix.empty()) RequireMatrixEnding("--write-matrix", a.matrix);
    context.KeepApart({{"MESH", a.mesh}}, {{"-o", a.output}, {"--write-matrix", a.matrix}});
    auto model = context.Load(a.mesh);
    if (a.level > 0) {
        model = engine::Model::Build(
            engine::RefineUniformly(model, {.levels = a.level}, context.GetJob()));
    }
    engine::FitResult const result = engine::FitToLimit(model, options, context.GetJob());
    AddToReport(context.GetReport(), result);
    AddToReport(context.GetReport(), evaluator.get());
    WarnOfSingular(context, a.mesh, result.report.singularComponents);
    if (!result.HasConverged() && !a.keepsResult)
        return context.MissTarget(Explain(a.mesh, result, options.tolerance));

    if (options.keepsTopology) {
        context.GetJob().Warn(
            fmt::format("{}: its limit passes through the data only if the first step is taken "
                        "with alpha {}, which no other "
                        "program does",
                        a.output, options.alpha));
    }
    if (isStationary && options.alpha > 0.0) {
        context.GetJob().Warn(
            fmt::format("{}: its limit passes through the data only if every step is taken with "
                        "alpha {}, as limn refine --alpha does and no other program",
                        a.output, options.alpha));
    }
    Write(a, model, result, context);
    return result.HasConverged() ? kDone
                                 : context.MissTarget(Explain(a.mesh, result, options.tolerance));
}

}  // namespace

Verb AddFit(CLI::App& app) {
    auto const a = std::make_shared<FitArguments>();
    CLI::App* const verb = app.add_subcommand(
        "fit", "Find the control mesh whose limit surface passes through a mesh's vertices");
    verb->add_option("MESH", a->mesh, "OBJ, PLY or OFF")->required();
    verb->add_option("-o,--output", a->output, "mesh to write, .obj or .ply")->required();
    AddNumberOption(*verb, "--tolerance", a->options.tolerance,
                    "of the largest miss, over the diagonal of the bounding box (default 1e-6)",
                    {1e-15, 1.0});
    AddWordOption(*verb, "--method", a->options.method, eval::kSolveMethodWords,
                  "auto (default): the fastest that converges");
    AddNumberOption(*verb, "--max-iterations", a->options.maxIterations,
                    "applications of the limit matrix (default 1000); auto factorises after them",
                    {1, 100000000});
    auto* const alpha =
        AddNumberOption(*verb, "--alpha", a->options.alpha,
                        "generalised Catmull-Clark, 0 (default) to 1; in the first step, the "
                        "result is one level finer",
                        {0.0, 1.0});
    AddAlphaRule(*verb, a->options.alphaRule, alpha);
    verb->add_flag("--keep-topology", a->options.keepsTopology,
                   "with --alpha in the first step: write the control mesh before that step");
    AddNumberOption(*verb, "--at-level", a->level,
                    "refine the mesh so often first, and fit the refined points (default 0)",
                    {0, 10});
    verb->add_flag("--keep-result", a->keepsResult,
                   "write the result even where it misses the tolerance (exit status 4)");
    verb->add_option("--write-matrix", a->matrix,
                     "also write A, which the fit solves with, as a Matrix Market file (.mtx)");
    AddEvaluatorOption(*verb, a->far.evaluator, "A, or far's table,");
    AddFarLimitOptions(*verb, a->far, "for the certificate");
    verb->footer("Example:\n  limn fit scenes/spot/spot.obj -o out/spot.fit.obj --report -");
    return {verb, [a, verb](Context& context) { return Run(*a, *verb, context); }};
}

}  // namespace limn::cli
