// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "engine/cli/cli.h"
#include "engine/cli/field/field_inputs.h"
#include "engine/cli/field/field_outputs.h"
#include "engine/cli/field/streamline_arguments.h"
#include "engine/cli/names.h"
#include "engine/cli/options/evaluator_option.h"
#include "engine/cli/options/number_option.h"
#include "engine/cli/options/option_rules.h"
#include "engine/field/circulation.h"
#include "engine/field/field.h"
#include "engine/field/form_matrices.h"
#include "engine/images/png.h"
#include "engine/io/edge_values.h"
#include "engine/io/mesh_writer.h"
#include "engine/measure/mesh_picture.h"
#include "far_ext/error.h"
#include "far_ext/forms/form_operators.h"

namespace limn::cli {

namespace {

constexpr char const* kWriteStencils = "--write-stencils";

struct FieldArguments {
    std::string mesh, output, along, picture;
    std::vector<double> view{1.0, 0.6, 0.8};
    std::vector<std::string> stencils;
    bool isLimit = false;
    std::optional<eval::EvaluatorKind> evaluator;
    FieldInputs inputs;
    StreamlineArguments streamlines;
};

void KeepFilesApart(FieldArguments const& a, FieldOutput output, Context const& context) {
    std::string const vectors = output == FieldOutput::Mesh ? NameVectors(a.output) : std::string();
    std::vector<NamedFile> read = a.inputs.ListFiles();
    read.push_back({"MESH", a.mesh});
    read.push_back({"--along", a.along});
    read.push_back(a.streamlines.GetInput());
    std::vector<NamedFile> written{
        {"-o", a.output}, {"-o", vectors}, a.streamlines.GetOutput(), {"--picture", a.picture}};
    for (std::string const& path : a.stencils) written.push_back({kWriteStencils, path});
    if (!a.stencils.empty()) {
        for (int level : {0, a.inputs.GetLevels()})
            written.push_back({kWriteStencils, engine::NameEdgeTable(a.stencils[0], level)});
    }
    context.KeepApart(read, written);
}

void CheckOutput(FieldArguments const& a, FieldOutput output) {
    if (a.isLimit && output != FieldOutput::Values)
        throw Error(ErrorCode::BadOption, "--limit needs -o x.values.csv");
    if (a.along.empty() != (output != FieldOutput::Along))
        throw Error(ErrorCode::BadOption, "--along and -o x.along.csv need each other");
}

void CheckStencils(FieldArguments const& a) {
    for (std::string const& path : a.stencils) RequireMatrixEnding(kWriteStencils, path);
    if (!a.stencils.empty() && a.inputs.GetLevels() == 0)
        throw Error(ErrorCode::BadOption, "--write-stencils: of --levels 0 they change nothing");
}

/// Vectors at vertices are limits, which a mesh has all over if its faces are all quads.
/// \throws Error BadOption: --levels 0 was typed, and is not enough
void RequireLevels(FieldArguments const& a, FieldOutput output, engine::Model const& model,
                   CLI::App const& verb) {
    bool const isEnough = a.inputs.GetLevels() > 0 || far_ext::HasRefinedFaces(model.GetCage());
    if (isEnough || output != FieldOutput::Mesh || verb.count("--levels") == 0) return;
    throw Error(ErrorCode::BadOption,
                "--levels 0: not all faces are quads, so that vectors at vertices take one level "
                "at least; use --levels 1, or -o x.faces.csv");
}

void WriteField(FieldArguments const& a, FieldOutput output, engine::Model const& model,
                engine::Field const& field, engine::MeshSequence& files,
                eval::TableEvaluator* evaluator, std::vector<std::string>& warnings,
                Context& context) {
    Precision const precision = context.GetCommon().GetPrecision();
    if (output == FieldOutput::Mesh) {
        Precision const ofMesh = context.ChoosePrecision(a.output, field.mesh.positions);
        context.GetReport()["precision_written"] = kPrecisionWords.GetWord(ofMesh);
        warnings = files.Add(a.output, field.mesh, ofMesh);
        files.Add(NameVectors(a.output), FormatVectors("vertex", field.vectors, precision));
    } else if (output == FieldOutput::Edges) {
        auto const level = field.refined->GetLevel(field.refined->GetMaxLevel());
        files.Add(a.output, engine::FormatEdgeValues(level, field.form));
    } else if (output == FieldOutput::Faces) {
        files.Add(a.output, FormatVectors("face", field.faceVectors, precision));
    } else if (output == FieldOutput::Values) {
        files.Add(a.output,
                  FormatFunction(a.isLimit ? engine::FindLimitValues(field) : field.values));
    } else if (output == FieldOutput::Integrals) {
        files.Add(a.output, FormatIntegrals(field));
    } else {
        auto const edges = engine::ReadEdgeList(a.along, model.GetLevel());
        files.Add(a.output, FormatAlong(engine::FindCirculations(model, field.controlForm, edges,
                                                                 context.GetJob(), evaluator)));
    }
}

int Run(FieldArguments const& a, CLI::App const& verb, Context& context) {
    FieldOutput const output = FindFieldOutput(a.output);
    CheckOutput(a, output);
    a.streamlines.Check(verb);
    RequirePngEnding("--picture", a.picture);
    CheckStencils(a);
    KeepFilesApart(a, output, context);
    auto const model = context.Load(a.mesh);
    RequireLevels(a, output, model, verb);
    auto const evaluator = MakeEvaluator(a.evaluator, context.GetCommon().precision);
    auto options = a.inputs.MakeOptions(model.GetLevel());
    options.evaluator = evaluator.get();
    bool const hasArrows = !a.picture.empty() && !a.streamlines.IsWanted();
    options.hasVertexVectors = output == FieldOutput::Mesh || hasArrows;
    if (output != FieldOutput::Mesh && options.hasVertexVectors && options.levels == 0 &&
        !far_ext::HasRefinedFaces(model.GetCage())) {
        throw Error(ErrorCode::BadOption,
                    "--picture: arrows stand at vertices of a refined mesh, and the output is that "
                    "of --levels 0; use --levels 1, or "
                    "leave --picture out");
    }
    auto const field = engine::DesignField(model, options, context.GetJob());
    AddToReport(context.GetReport(), field.audit);
    std::optional<engine::Streamlines> streamlines;
    if (a.streamlines.IsWanted())
        streamlines = a.streamlines.Trace(model, field.controlForm, evaluator.get(), context);

    std::vector<std::string> warnings;
    engine::MeshSequence files;
    context.GetJob().Start("writing " + a.output);
    WriteField(a, output, model, field, files, evaluator.get(), warnings, context);
    AddToReport(context.GetReport(), evaluator.get());
    if (streamlines) a.streamlines.Write(model, *streamlines, context, files);
    if (!a.picture.empty()) {
        context.GetJob().Start("drawing " + a.picture);
        engine::PictureView const view{{a.view[0], a.view[1], a.view[2]}};
        engine::WritePng(files.Open(a.picture),
                         streamlines
                             ? engine::DrawLines(field.mesh, streamlines->ListPoints(), view)
                             : engine::DrawArrows(field.mesh, field.vectors, view));
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
                     "values along edges; x.faces.csv: a vector per face; x.values.csv: the "
                     "function whose gradient the field has; x.integrals.csv: its curl over faces; "
                     "x.along.csv: the limit's circulation along the edges of --along")
        ->required();
    a->inputs.Add(*verb);
    verb->add_flag("--limit", a->isLimit, "with -o x.values.csv: values of the limit");
    verb->add_option("--along", a->along,
                     "CSV v0,v1: edges of MESH along whose limits -o x.along.csv has the field");
    AddEvaluatorOption(*verb, a->evaluator, "refinement and vectors at vertices");
    verb->add_option(kWriteStencils, a->stencils,
                     "S1.mtx,S2.mtx: also write the subdivision of 1-forms and 2-forms down to "
                     "--levels as Matrix Market files; S1.edges0.csv and S1.edgesK.csv number the "
                     "edges")
        ->delimiter(',')
        ->expected(2);
    auto* const picture = verb->add_option("--picture", a->picture,
                                           "also write a PNG: the mesh with its streamlines or, "
                                           "without --streamlines, with arrows along the field");
    AddNumberOption(*verb, "--view", a->view,
                    "the picture's side that is seen, x,y,z (default 1,0.6,0.8)")
        ->delimiter(',')
        ->expected(3)
        ->needs(picture);
    a->streamlines.Add(*verb);
    verb->footer(
        "Example:\n  limn field scenes/spot/spot.obj -o out/spot.field.obj --levels 2 --source 0 "
        "--sink 100 --vortex 40 --vortex 150:-1");
    return {verb, [a, verb](Context& context) { return Run(*a, *verb, context); }};
}

}  // namespace limn::cli
