// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "engine/cli/cli.h"
#include "engine/cli/names.h"
#include "engine/cli/options/number_option.h"
#include "engine/cli/options/option_rules.h"
#include "engine/cli/options/word_option.h"
#include "engine/field/field.h"
#include "engine/field/form_matrices.h"
#include "engine/images/png.h"
#include "engine/io/edge_values.h"
#include "engine/io/file.h"
#include "engine/io/mesh_writer.h"
#include "engine/io/number_table.h"
#include "engine/measure/mesh_picture.h"
#include "far_ext/error.h"
#include "far_ext/forms/form_operators.h"

namespace limn::cli {

namespace {

constexpr char const* kWriteStencils = "--write-stencils";

struct FieldArguments {
    std::string mesh, output, edgesPath, matchPath, harmonics, picture;
    std::vector<double> view{1.0, 0.6, 0.8};
    std::vector<std::string> sources, sinks, vortices, stencils;
    engine::FieldOptions options;
};

/// "12" or "12:0.5".
engine::FieldStrength ParseStrength(std::string const& text, char const* option, double sign) {
    size_t const colon = std::min(text.find(':'), text.size());
    auto const element = ParseNumber<Index>(option, std::string_view(text).substr(0, colon));
    double const strength =
        colon < text.size() ? ParseNumber<double>(option, std::string_view(text).substr(colon + 1))
                            : 1.0;
    return {element, sign * strength};
}

std::vector<double> ParseList(std::string const& text, char const* option) {
    std::vector<double> values;
    for (size_t start = 0; start <= text.size() && !text.empty();) {
        size_t const comma = std::min(text.find(',', start), text.size());
        values.push_back(
            ParseNumber<double>(option, std::string_view(text).substr(start, comma - start)));
        start = comma + 1;
    }
    return values;
}

std::vector<eval::WantedVector> ReadWanted(std::string const& path,
                                           Far::TopologyLevel const& level) {
    auto const table =
        engine::ReadNumberTable(path, {{"face", "x", "y", "z"}, {"vertex", "x", "y", "z"}});
    bool const isFace = table.layout == 0;
    int const count = isFace ? level.GetNumFaces() : level.GetNumVertices();
    std::vector<eval::WantedVector> wanted;
    for (size_t row = 0; row < table.GetNumRows(); ++row) {
        Index const element =
            engine::GetIndex(table, path, row, 0, count, isFace ? "face" : "vertex");
        wanted.push_back(
            {isFace, element, {table.Get(row, 1), table.Get(row, 2), table.Get(row, 3)}});
    }
    return wanted;
}

engine::FieldOptions MakeOptions(FieldArguments const& a, Far::TopologyLevel const& level) {
    engine::FieldOptions options = a.options;
    for (auto const& text : a.sources)
        options.sources.push_back(ParseStrength(text, "--source", 1.0));
    for (auto const& text : a.sinks) options.sources.push_back(ParseStrength(text, "--sink", -1.0));
    for (auto const& text : a.vortices)
        options.vortices.push_back(ParseStrength(text, "--vortex", 1.0));
    if (!a.harmonics.empty()) options.harmonics = ParseList(a.harmonics, "--harmonic");
    if (!a.edgesPath.empty()) options.edges = engine::ReadEdgeValues(a.edgesPath, level);
    if (!a.matchPath.empty()) options.wanted = ReadWanted(a.matchPath, level);
    if (options.sources.empty() && options.vortices.empty() && !options.harmonics &&
        !options.edges && a.matchPath.empty()) {
        throw Error(ErrorCode::BadOption,
                    "a field needs at least one of --source, --sink, --vortex, --harmonic, --edges "
                    "and --match");
    }
    return options;
}

std::string FormatVectors(char const* element, std::vector<std::array<double, 3>> const& vectors,
                          Precision precision) {
    int const digits = precision == Precision::Double ? 17 : 9;
    std::string text = fmt::format("{},x,y,z\n", element);
    for (size_t i = 0; i < vectors.size(); ++i) {
        auto const& v = vectors[i];
        fmt::format_to(std::back_inserter(text), "{},{:.{}g},{:.{}g},{:.{}g}\n", i, v[0], digits,
                       v[1], digits, v[2], digits);
    }
    return text;
}

enum class Output { Mesh, Edges, Faces };

Output FindOutput(std::string const& path) {
    if (path.ends_with(".edges.csv")) return Output::Edges;
    if (path.ends_with(".faces.csv")) return Output::Faces;
    std::string const ending = engine::GetEnding(path);
    if (ending == ".obj" || ending == ".ply") return Output::Mesh;
    throw Error(ErrorCode::BadOption,
                fmt::format("-o '{}': a field is written as .obj or .ply (and .vectors.csv beside "
                            "it), .edges.csv or .faces.csv",
                            path));
}

void AddToReport(nlohmann::json& report, engine::FieldAudit const& audit) {
    report["sum_of_indices"] = audit.indices.sum;
    report["euler_characteristic"] = audit.eulerCharacteristic;
    report["max_curl_of_gradient"] = audit.maxCurlOfGradient;
    report["max_divergence_of_vortex_part"] = audit.maxDivergenceOfVortex;
    report["commutation_d0"] = audit.commutationD0;
    report["commutation_d1"] = audit.commutationD1;
    report["parts"] = {{"gradient", audit.gradientNorm},
                       {"vortex", audit.vortexNorm},
                       {"harmonic", audit.harmonicNorm}};
    report["generators"] = audit.numGenerators;
    report["solve_seconds"] = audit.solveSeconds;
    auto& list = report["singularities"] = nlohmann::json::array();
    for (auto const& singularity : audit.indices.singularities)
        list.push_back({{singularity.isFace ? "face" : "vertex", singularity.element},
                        {"index", singularity.index}});
}

/// The vectors beside a mesh.
std::string NameVectors(std::string const& mesh) {
    return mesh.substr(0, mesh.rfind('.')) + ".vectors.csv";
}

void KeepFilesApart(FieldArguments const& a, Output output, Context const& context) {
    std::string const vectors = output == Output::Mesh ? NameVectors(a.output) : std::string();
    std::vector<NamedFile> written{{"-o", a.output}, {"-o", vectors}, {"--picture", a.picture}};
    for (std::string const& path : a.stencils) written.push_back({kWriteStencils, path});
    if (!a.stencils.empty()) {
        for (int level : {0, a.options.levels})
            written.push_back({kWriteStencils, engine::NameEdgeTable(a.stencils[0], level)});
    }
    context.KeepApart({{"MESH", a.mesh}, {"--edges", a.edgesPath}, {"--match", a.matchPath}},
                      written);
}

void CheckStencils(FieldArguments const& a) {
    for (std::string const& path : a.stencils) RequireMatrixEnding(kWriteStencils, path);
    if (!a.stencils.empty() && a.options.levels == 0)
        throw Error(ErrorCode::BadOption, "--write-stencils: of --levels 0 they change nothing");
}

/// Vectors at vertices are limits, which a mesh has all over if its faces are all quads.
/// \throws Error BadOption: --levels 0 was typed, and is not enough
void RequireLevels(FieldArguments const& a, Output output, engine::Model const& model,
                   CLI::App const& verb) {
    bool const isEnough = a.options.levels > 0 || far_ext::HasRefinedFaces(model.GetCage());
    if (isEnough || output != Output::Mesh || verb.count("--levels") == 0) return;
    throw Error(ErrorCode::BadOption,
                "--levels 0: not all faces are quads, so that vectors at vertices take one level "
                "at least; use --levels 1, or -o x.faces.csv");
}

int Run(FieldArguments const& a, CLI::App const& verb, Context& context) {
    Output const output = FindOutput(a.output);
    RequirePngEnding("--picture", a.picture);
    CheckStencils(a);
    KeepFilesApart(a, output, context);
    auto const model = context.Load(a.mesh);
    RequireLevels(a, output, model, verb);
    auto options = MakeOptions(a, model.GetLevel());
    options.hasVertexVectors = output == Output::Mesh || !a.picture.empty();
    if (output != Output::Mesh && options.hasVertexVectors && options.levels == 0 &&
        !far_ext::HasRefinedFaces(model.GetCage())) {
        throw Error(ErrorCode::BadOption,
                    "--picture: arrows stand at vertices of a refined mesh, and the output is that "
                    "of --levels 0; use --levels 1, or "
                    "leave --picture out");
    }
    auto const field = engine::DesignField(model, options, context.GetJob());
    AddToReport(context.GetReport(), field.audit);

    Precision const precision = context.GetCommon().GetPrecision();
    std::vector<std::string> warnings;
    engine::MeshSequence files;
    context.GetJob().Start("writing " + a.output);
    if (output == Output::Mesh) {
        Precision const ofMesh = context.ChoosePrecision(a.output, field.mesh.positions);
        context.GetReport()["precision_written"] = kPrecisionWords.GetWord(ofMesh);
        warnings = files.Add(a.output, field.mesh, ofMesh);
        files.Add(NameVectors(a.output), FormatVectors("vertex", field.vectors, precision));
    } else if (output == Output::Edges) {
        files.Add(a.output,
                  engine::FormatEdgeValues(field.refined->GetLevel(options.levels), field.form));
    } else {
        files.Add(a.output, FormatVectors("face", field.faceVectors, precision));
    }
    if (!a.picture.empty()) {
        context.GetJob().Start("drawing " + a.picture);
        engine::WritePng(
            files.Open(a.picture),
            engine::DrawArrows(field.mesh, field.vectors, {{a.view[0], a.view[1], a.view[2]}}));
    }
    if (!a.stencils.empty()) {
        context.GetJob().Start("writing " + a.stencils[0]);
        engine::AddFormMatrices(*field.refined, options.levels, a.stencils[0], a.stencils[1],
                                files);
    }
    files.Commit();
    context.Warn(warnings);
    return kDone;
}

}  // namespace

Verb AddField(CLI::App& app) {
    auto const a = std::make_shared<FieldArguments>();
    CLI::App* const verb = app.add_subcommand(
        "field", "Design a tangent vector field, and subdivide it with the surface");
    verb->add_option("MESH", a->mesh, "OBJ, PLY or OFF")->required();
    verb->add_option("-o,--output", a->output,
                     "x.obj or x.ply: the refined mesh, with x.vectors.csv beside it; x.edges.csv: "
                     "values along edges; x.faces.csv: a vector per face")
        ->required();
    auto const repeated = [&](char const* name, std::vector<std::string>& values,
                              char const* help) {
        verb->add_option(name, values, help)
            ->expected(1)
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
            ->type_name("N[:STRENGTH]");
    };
    repeated("--source", a->sources,
             "vertex out of which the field flows (repeatable; strength 1)");
    repeated("--sink", a->sinks, "vertex into which it flows (repeatable)");
    repeated("--vortex", a->vortices, "face round which it turns, counter-clockwise (repeatable)");
    verb->add_option("--harmonic", a->harmonics,
                     "c1,c2,...: circulations round handles and holes, one per generator");
    verb->add_option("--edges", a->edgesPath,
                     "CSV v0,v1,value: a field along edges of MESH, to be added");
    verb->add_option("--match", a->matchPath,
                     "CSV face,x,y,z or vertex,x,y,z: vectors that the field is to fit");
    AddNumberOption(*verb, "--levels", a->options.levels,
                    "refinements (default 0; 1 where faces are not all quads)", {0, 10});
    AddWordOption(*verb, "--at-boundary", a->options.atBoundary, kAtBoundaryWords,
                  "tangent (default): the field runs along boundaries; normal: into them");
    verb->add_flag("--balance", a->options.isBalanced,
                   "spread what strengths do not add up to evenly over their component");
    verb->add_option(kWriteStencils, a->stencils,
                     "S1.mtx,S2.mtx: also write the subdivision of 1-forms and 2-forms down to "
                     "--levels as Matrix Market files; S1.edges0.csv and S1.edgesK.csv number the "
                     "edges")
        ->delimiter(',')
        ->expected(2);
    auto* const picture = verb->add_option("--picture", a->picture,
                                           "also write a PNG: arrows along the field, on the mesh");
    AddNumberOption(*verb, "--view", a->view,
                    "the picture's side that is seen, x,y,z (default 1,0.6,0.8)")
        ->delimiter(',')
        ->expected(3)
        ->needs(picture);
    verb->footer(
        "Example:\n  limn field scenes/spot/spot.obj -o out/spot.field.obj --levels 2 --source 0 "
        "--sink 100 --vortex 40 --vortex 150:-1");
    return {verb, [a, verb](Context& context) { return Run(*a, *verb, context); }};
}

}  // namespace limn::cli
