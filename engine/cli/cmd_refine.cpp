// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "engine/cli/cli.h"
#include "engine/cli/names.h"
#include "engine/cli/option_rules.h"
#include "engine/cli/word_option.h"
#include "engine/differential/differential.h"
#include "engine/differential/edit_reader.h"
#include "engine/differential/polyline_file.h"
#include "engine/io/mesh_writer.h"
#include "engine/scene/refine.h"
#include "engine/scene/subdivision_names.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

using far_ext::SubdivisionRule;

/// Options that only meshes in differential space have.
std::vector<char const*> const kDifferentialOptions{"--laplacian",  "--dirmag", "--spatial-first",
                                                    "--handle",     "--solver", "--edit",
                                                    "--keep-result"};

struct RefineArguments {
    std::string mesh, output, editPath;
    std::optional<NamedRule> rule;
    int levels = 1;
    bool isDifferential = false, toLimit = false, keepsResult = false, isCurve = false;
    engine::DifferentialOptions options;
};

/// The scheme follows the rule where one is named.
SubdivisionRule ChooseRule(RefineArguments const& a, CommonOptions const& common,
                           far_ext::ControlMesh& cage) {
    if (!a.rule) return SubdivisionRule::Scheme;
    if (common.scheme && a.rule->scheme != cage.scheme) {
        throw Error(ErrorCode::BadOption, fmt::format("--rule {} contradicts --scheme {}",
                                                      kRuleWords.GetWord(*a.rule), *common.scheme));
    }
    cage.scheme = a.rule->scheme;
    far_ext::Validate(cage);  // triangles only, where the rule asks for them
    return a.rule->rule;
}

engine::DifferentialOptions MakeOptions(RefineArguments const& a, SubdivisionRule rule,
                                        bool isDouble) {
    engine::DifferentialOptions options = a.options;
    options.rule = rule;
    options.tolerance =
        isDouble ? 1e-12 : 1e-8;  // what is written should be right to its last digits
    if (!a.editPath.empty()) options.edit = engine::ReadCurvatureEdit(a.editPath);
    return options;
}

/// \return false where the solver missed its tolerance
bool RefineDifferentially(RefineArguments const& a, Context& context, SubdivisionRule rule,
                          engine::Scene const& scene, engine::Scene& fine) {
    auto const options = MakeOptions(a, rule, context.GetCommon().IsDouble());
    engine::DifferentialReport found;
    fine = engine::RefineDifferentially(scene, a.levels, options,
                                        context.GetCommon().IsLeftHanded() ? -1.0 : 1.0, found);
    for (std::string const& warning : found.warnings) context.GetJob().Warn(warning);
    auto& report = context.GetReport();
    report["unknowns"] = found.unknowns;
    report["iterations"] = found.iterations;
    report["solve_seconds"] = found.solveSeconds;
    report["residual"] = found.residual;
    report["compatibility_defect"] = found.compatibilityDefect;
    report["converged"] = found.converged;
    report["tangential_share"] = found.tangentialShare;
    report["size_ratio"] = found.sizeRatio;
    report["thin_plate_energy"] = found.energy.mean;
    report["thin_plate_energy_area"] = found.energy.integral;
    if (!found.converged) {
        context.GetJob().Warn(fmt::format(
            "the solver stopped at residual {:.1e} after {} iterations{}", found.residual,
            found.iterations, a.keepsResult ? "" : "; nothing is written without --keep-result"));
    }
    return found.converged;
}

void CheckSpace(RefineArguments const& a, CLI::App const& verb) {
    if (!a.isDifferential)
        return RefuseEach(verb, kDifferentialOptions, "needs --space differential");
    if (a.toLimit) {
        throw Error(ErrorCode::BadOption,
                    "--limit: the limit of --space differential has no closed form; leave it out");
    }
}

/// Polylines by the rule that boundaries follow: cubic B-spline, or four-point for butterfly.
int RefineCurves(RefineArguments const& a, CLI::App const& verb, Context& context) {
    constexpr char const* kWhy = "means nothing with --curve; leave it out";
    RefuseEach(verb, kDifferentialOptions, kWhy);
    RefuseEach(verb, {"--limit"}, kWhy);
    bool const isButterfly = a.rule && a.rule->rule == SubdivisionRule::Butterfly;
    auto const rule = isButterfly ? eval::CurveRule::FourPoint : eval::CurveRule::CubicBSpline;
    auto curves = engine::ReadPolylines(a.mesh);
    eval::CurveReport worst;
    size_t numPoints = 0;
    auto const start = std::chrono::steady_clock::now();
    for (eval::Curve& curve : curves) {
        if (a.isDifferential) {
            eval::CurveReport report;
            curve = eval::RefineCurveDifferentially(curve, rule, a.levels, &report);
            worst.residual = std::max(worst.residual, report.residual);
            worst.compatibilityDefect =
                std::max(worst.compatibilityDefect, report.compatibilityDefect);
        } else {
            for (int level = 0; level < a.levels; ++level)
                curve = eval::SubdivideCurve(curve, rule);
        }
        numPoints += curve.points.size();
    }
    std::chrono::duration<double> const elapsed = std::chrono::steady_clock::now() - start;
    engine::WritePolylines(a.output, curves, context.GetCommon().IsDouble());
    auto& report = context.GetReport();
    report["inputs"].push_back(
        {{"path", a.mesh}, {"sha256", engine::Sha256OfFile(a.mesh)}, {"curves", curves.size()}});
    report["vertices"] = report["unknowns"] = numPoints;
    report["solve_seconds"] = elapsed.count();
    report["residual"] = worst.residual;
    report["compatibility_defect"] = worst.compatibilityDefect;
    return kDone;
}

int RunRefine(RefineArguments const& a, CLI::App const& verb, Context& context) {
    if (a.isCurve) return RefineCurves(a, verb, context);
    CheckSpace(a, verb);
    auto [scene, refiner] = context.Load(a.mesh);
    SubdivisionRule const rule = ChooseRule(a, context.GetCommon(), scene.cage);
    context.GetReport()["inputs"].back()["subdivision"] = engine::DescribeSubdivision(scene.cage);
    engine::Scene fine;
    bool isDone = true;
    if (a.isDifferential)
        isDone = RefineDifferentially(a, context, rule, scene, fine);
    else
        fine = engine::RefineUniformly(scene, a.levels, a.toLimit, rule);
    if (isDone || a.keepsResult) {
        std::vector<std::string> warnings;
        engine::WriteMesh(a.output, fine, context.GetCommon().IsDouble(), &warnings);
        for (std::string const& warning : warnings) context.GetJob().Warn(warning);
    }
    context.GetReport()["vertices"] = fine.cage.numVertices;
    context.GetReport()["faces"] = fine.cage.GetNumFaces();
    return isDone ? kDone : kNotReached;
}

}  // namespace

Verb AddRefine(CLI::App& app) {
    auto const a = std::make_shared<RefineArguments>();
    CLI::App* const verb = app.add_subcommand("refine", "Subdivide a mesh");
    verb->add_option("MESH", a->mesh, "OBJ, PLY or OFF")->required();
    verb->add_option("-o,--output", a->output, "mesh to write, .obj or .ply")->required();
    verb->add_option("--levels", a->levels, "how often (default 1)")->check(CLI::Range(0, 10));
    AddWordOption(*verb, "--space", a->isDifferential, kIsDifferentialWords,
                  "spatial (default): rules on positions; differential: on mean-curvature normals");
    AddWordOption(*verb, "--rule", a->rule, kRuleWords,
                  "loop, catmark or butterfly (default: the scheme's)");
    verb->add_flag("--limit", a->toLimit, "move the result's vertices to the limit surface");
    verb->add_flag(
        "--curve", a->isCurve,
        "MESH holds polylines (OBJ 'l'); their rule is cubic B-spline, for butterfly four-point");
    auto const differential = [](CLI::Option* option) {
        return option->group("Options of --space differential");
    };
    differential(AddWordOption(*verb, "--laplacian", a->options.laplacian, kLaplacianWords,
                               "combinatorial (default), cotangent or mesh"));
    differential(verb->add_option("--dirmag", a->options.dirMagLevels,
                                  "first levels done by direction and magnitude (default 0)"))
        ->check(CLI::Range(0, 10));
    differential(verb->add_option("--spatial-first", a->options.spatialLevels,
                                  "levels done in space before (default 0)"))
        ->check(CLI::Range(0, 10));
    differential(
        verb->add_option("--handle", a->options.handles,
                         "vertex that stays: one per component or boundary loop (repeatable)"));
    differential(AddWordOption(*verb, "--solver", a->options.usesCholesky, kUsesCholeskyWords,
                               "multigrid (default) or cholesky"));
    differential(
        verb->add_option("--edit", a->editPath, "JSON: curvature factors, rotations, filter"));
    differential(verb->add_flag("--keep-result", a->keepsResult,
                                "write what a solver that missed its tolerance has"));
    verb->footer(
        "Example:\n  limn refine scenes/spot/spot.obj -o out/spot.2.obj --levels 2 --space "
        "differential");
    return {verb, [a, verb](Context& context) { return RunRefine(*a, *verb, context); }};
}

}  // namespace limn::cli
