// SPDX-License-Identifier: Apache-2.0
//
// End to end, through the library: bytes choose a mesh, perhaps a format that it goes through, a
// verb and its options. What comes out has the size it must have, is made of numbers, and lies
// where a limit can lie.

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/bake/bake.h"
#include "engine/differential/differential.h"
#include "engine/evaluate/evaluate.h"
#include "engine/fit/fit.h"
#include "engine/measure/measure.h"
#include "engine/scene/mesh_info.h"
#include "engine/scene/refine.h"
#include "engine/scene/weld.h"
#include "fuzz/choices.h"
#include "fuzz/fuzzer.h"
#include "fuzz/meshes.h"
#include "fuzz/promises.h"
#include "fuzz/same_scene.h"
#include "fuzz/verbs.h"

namespace limn::fuzz {

namespace {

using engine::Job;
using engine::Model;
using engine::Scene;

// A verb each.

void Describe(Model const& model, Choices&, Job&) {
    auto const info = engine::DescribeMesh(model);
    Index faces = 0;
    for (auto const& [size, count] : info.facesBySize) faces += count;
    Require(faces == info.faces && faces == model.GetCage().GetNumFaces(), "faces are counted");
    Require(info.vertices - info.edges + info.faces == info.eulerCharacteristic ||
                !info.defects.empty(),
            "V - E + F is Euler's number where nothing is wrong");
}

void Evaluate(Model const& model, Choices& choices, Job& job) {
    std::vector<Index> faces;
    std::vector<double> s, t;
    for (int count = choices.TakeInt(1, 8); count > 0; --count) {
        faces.push_back(choices.TakeInt(0, model.GetCage().GetNumFaces() - 1));
        s.push_back(choices.Pick({0.0, 0.25, 0.5, 1.0, 1e-9, choices.TakeShare()}));
        t.push_back(choices.Pick({0.0, 0.25, 0.5, 1.0, 1e-9, choices.TakeShare()}));
    }
    auto const values = engine::EvaluateLimit(model, {faces, s, t}, Orientation::Right, job);
    Hull const hull(model.GetPositions());
    for (size_t i = 0; i < faces.size(); ++i) {
        if (!values.hasLimit[i]) continue;
        Require(hull.Holds(std::span<double const>(&values.positions[3 * i], 3), 1e-9),
                "limits lie within four times the hull of the control points");
        double const* const n = &values.normals[3 * i];
        double const length = std::hypot(n[0], n[1], n[2]);
        Require(length == 0.0 || std::abs(length - 1.0) < 1e-9, "a normal has length 1, or is 0");
        Require(AreFinite(std::initializer_list<double>{values.mean[i], values.gaussian[i],
                                                        values.k1[i], values.k2[i]}),
                "curvature is a number");
    }
}

far_ext::TunedRule ChooseRule(Choices& choices) {
    using enum far_ext::SubdivisionRule;
    if (!choices.TakeOneIn(4)) return Scheme;
    return choices.Pick<far_ext::TunedRule>({Butterfly,
                                             OriginalButterfly,
                                             {OriginalButterfly, 0.1},
                                             Kobbelt,
                                             {Kobbelt, 2.0},
                                             Interpolating});
}

void Refine(Model const& model, Choices& choices, Job& job) {
    engine::RefineOptions options{.levels = choices.TakeInt(0, 2), .toLimit = choices.TakeBool()};
    options.rule = ChooseRule(choices);
    Scene const fine = engine::RefineUniformly(model, options, job);
    if (!options.rule.IsInterpolating()) RequireInHull(model, fine.positions);
    RequireMesh(fine);
}

void WeldTwice(Model const& model, Choices& choices, Job&) {
    double const tolerance = choices.Pick({0.0, 1e-6, 0.01, 0.3});
    Scene const once = engine::Weld(model.MakeScene(), tolerance);
    RequireMesh(once);
    Scene const twice = MustSucceed("what was welded can be welded again",
                                    [&] { return engine::Weld(once, tolerance); });
    RequireSame(once, twice, {});
}

/// What doubles lose of a mesh's coordinates, over the diagonal of its box.
double FindRounding(Model const& model) {
    double largest = 0.0;
    for (double const coordinate : model.GetPositions())
        largest = std::max(largest, std::abs(coordinate));
    double const diagonal = Hull(model.GetPositions()).GetDiagonal();
    return 1e-13 + 1e-13 * (diagonal > 0.0 ? largest / diagonal : 0.0);
}

void Fit(Model const& model, Choices& choices, Job& job) {
    engine::FitOptions options{.tolerance = choices.Pick({1e-6, 1e-3, 1e-9, 1e-12}),
                               .maxIterations = choices.Pick({100, 1, 1000})};
    using Method = eval::SolveMethod;
    options.method = choices.Pick({Method::Automatic, Method::Progressive, Method::Weighted,
                                   Method::Chebyshev, Method::ConjugateGradients, Method::Direct});
    options.alpha = choices.Pick({0.0, 0.0, 0.5, 1.0});
    options.keepsTopology = choices.TakeBool();
    auto const result = engine::FitToLimit(model, options, job);
    RequireMesh(result.mesh);
    Require(!result.HasConverged() || result.certificate.max <= 1.02 * options.tolerance,
            "the limit of a fit that converged passes through its data");
    // Where a face has one corner twice, or vertices are torn, alpha's step may miss; then it says
    // so.
    bool const isSound = engine::DescribeMesh(model).defects.empty();
    Require(!isSound || !result.report.converged ||
                result.certificate.max <= 1.02 * options.tolerance + FindRounding(model),
            "on a sound mesh a solver that converged has solved for the limit");
}

void MeasureSurface(Model const& model, Choices& choices, Job& job) {
    auto const surface =
        choices.Pick({engine::MeasuredSurface::Limit, engine::MeasuredSurface::Mesh});
    auto const measured = engine::Measure(model, surface, Orientation::Right, job);
    Require(measured.area >= 0.0 && AreFinite(std::initializer_list<double>{
                                        measured.area, measured.volume.value_or(0.0)}),
            "area and volume are numbers");
    auto const curvature = engine::FindVertexCurvature(model, surface, Orientation::Right, job);
    Require(AreFinite(curvature.mean) && AreFinite(curvature.gaussian), "curvature is a number");
    Require(curvature.mean.size() == static_cast<size_t>(model.GetCage().numVertices),
            "every vertex has a curvature");
}

void RefineInDifferentialSpace(Model const& model, Choices& choices, Job& job) {
    engine::DifferentialOptions options{.levels = choices.TakeInt(0, 2)};
    options.rule = ChooseRule(choices);
    options.laplacian = choices.Pick(
        {engine::Laplacian::Combinatorial, engine::Laplacian::Cotangent, engine::Laplacian::Mesh});
    options.dirMagLevels = choices.TakeInt(0, 1);
    options.spatialLevels = choices.TakeInt(0, 1);
    if (choices.TakeBool()) options.solver = engine::DifferentialSolver::Cholesky;
    Index const numVertices = model.GetCage().numVertices;
    if (choices.TakeOneIn(4)) options.handles.push_back(choices.TakeInt(0, numVertices));
    if (choices.TakeOneIn(4))
        options.edit.factors.push_back({choices.TakeInt(0, numVertices), choices.TakeSigned()});
    if (choices.TakeOneIn(4))
        options.edit.rotations.push_back({choices.TakeInt(0, numVertices), {0, 0, 1}, 30.0});
    options.edit.isPolarised = choices.TakeOneIn(4);
    if (choices.TakeOneIn(4))
        options.edit.means.push_back({choices.TakeInt(0, numVertices), 9.0 * choices.TakeSigned()});
    if (choices.TakeOneIn(4))
        options.edit.normals.push_back({choices.TakeInt(0, numVertices), {0.3, 0, 1}});
    if (choices.TakeOneIn(4)) options.edit.filterPoints = {{0.0, choices.TakeShare()}, {1.0, 1.0}};
    auto const result = engine::RefineDifferentially(model, options, job);
    RequireMesh(result.mesh);
}

engine::BakeOptions ChooseBake(Model const& model, Choices& choices) {
    static constexpr char const* kMaps[] = {
        "mean",        "normal",  "position",     "curvature", "principal-direction",
        "shape-index", "stretch", "overlap",      "gaussian",  "curvedness",
        "bands",       "noise",   "k1",           "k2",        "displacement",
        "tension",     "field",   "primvar:color"};
    engine::BakeOptions options;
    options.maps = {choices.Pick(kMaps)};
    if (choices.TakeOneIn(3)) options.maps.emplace_back(choices.Pick(kMaps));
    options.width = choices.Pick({16, 8, 32, 1, 7});
    options.height = choices.Pick({16, 8, 32, 1, 65});
    options.samplesPerSide = choices.TakeInt(1, 2);
    options.padding = choices.TakeInt(0, 3);
    options.hasMips = choices.TakeOneIn(4);
    options.isVector = choices.TakeBool();
    options.space = choices.Pick(
        {engine::VectorSpace::Object, engine::VectorSpace::Tangent, engine::VectorSpace::UV});
    options.isNormalized = choices.TakeBool();
    options.noise.octaves = choices.TakeInt(1, 2);
    options.bands = choices.TakeInt(2, 4);
    options.against = options.rest = model.WithPoints(model.GetPositions());
    options.field.emplace();
    for (Index edge = 0; edge < model.GetLevel().GetNumEdges(); ++edge)
        options.field->push_back(choices.TakeSigned());
    if (choices.TakeBool()) options.orientation = Orientation::Left;
    if (choices.TakeOneIn(4)) options.tiles = {choices.Pick({1001, 1002, 1011, 1999})};
    return options;
}

/// Requires what holds for a texel of a map, as far as its map is known.
void RequireTexels(engine::BakedImage const& image, Hull const& hull) {
    Require(AreFinite(image.texels), "there is no NaN in a map");
    bool const isPosition = image.map == "position", isNormal = image.map == "normal";
    for (int row = 0; row < image.height; ++row) {
        for (int column = 0; column < image.width; ++column) {
            float const coverage = image.GetCoverage(row, column);
            Require(coverage >= 0.0f && coverage <= 1.0f, "coverage is a share");
            if (coverage == 0.0f) continue;
            auto const texel = image.GetTexel(row, column);
            if (isPosition) Require(hull.Holds(texel, 1e-5), "baked positions are limits");
            if (isNormal)
                Require(std::hypot(texel[0], texel[1], texel[2]) < 1.0f + 1e-4f,
                        "a normal has length 1, or is 0");
        }
    }
}

void Bake(Model const& model, Choices& choices, Job& job) {
    auto const options = ChooseBake(model, choices);
    auto const baked = engine::BakeToMemory(model, options, job);
    Hull const hull(model.GetPositions());
    for (auto const& image : baked.images) {
        size_t const numTexels = static_cast<size_t>(options.width * options.height);
        Require(image.width == options.width && image.height == options.height &&
                    image.texels.size() == numTexels * image.channels.size() &&
                    image.coverage.size() == numTexels,
                "an image has the size that was asked for");
        RequireTexels(image, hull);
    }
}

/// The mesh, perhaps as its file is read.
Model ChooseModel(Choices& choices) {
    Scene scene = ChooseMesh(choices);
    bool const isFile = choices.TakeOneIn(4);
    Model model = Model::Build(std::move(scene));
    if (isFile) RequireRoundTrips(model.MakeScene());
    return model;
}

void RunVerb(Choices& choices) {
    static constexpr void (*kVerbs[])(Model const&, Choices&, Job&) = {
        Bake,           Evaluate, Refine,   Fit,  Filter,    Smooth,   Design,
        MeasureSurface, Bake,     MorphTo,  Bake, WeldTwice, Describe, RefineInDifferentialSpace,
        SumBands,       Combine,  DrawLines};
    auto* const verb = choices.Pick(kVerbs);
    Model const model = ChooseModel(choices);
    // Some are interrupted, at whichever time they ask.
    int numQuestions = choices.TakeOneIn(8) ? choices.TakeInt(0, 255) : -1;
    Job job({.isStopped = [&] { return numQuestions >= 0 && numQuestions-- == 0; }});
    verb(model, choices, job);
}

}  // namespace

}  // namespace limn::fuzz

extern "C" int LLVMFuzzerTestOneInput(uint8_t const* data, size_t size) {
    using namespace limn::fuzz;
    UseOneThread();
    Choices choices({data, size});
    Succeeds([&] { RunVerb(choices); });
    return 0;
}
