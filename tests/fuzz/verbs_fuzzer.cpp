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
#include "engine/field/field.h"
#include "engine/fit/bands.h"
#include "engine/fit/fit.h"
#include "engine/fit/morph.h"
#include "engine/io/mesh_reader.h"
#include "engine/measure/measure.h"
#include "engine/scene/mesh_info.h"
#include "engine/scene/refine.h"
#include "engine/scene/weld.h"
#include "engine/smooth/smooth.h"
#include "fuzz/choices.h"
#include "fuzz/fuzzer.h"
#include "fuzz/meshes.h"
#include "fuzz/same_scene.h"

namespace limn::fuzz {

namespace {

using engine::Job;
using engine::Model;
using engine::Scene;

template <class Values>
bool AreFinite(Values const& values) {
    return std::ranges::all_of(values, [](auto value) { return std::isfinite(value); });
}

/// The room that limits may take: weights of subdivision may be negative, but only by little, so
/// they stay within four times the box of the control points about its middle.
class Hull {
public:
    explicit Hull(std::vector<double> const& points) {
        for (int c = 0; c < 3; ++c) {
            double low = points[c], high = points[c];
            for (size_t i = c; i < points.size(); i += 3) {
                low = std::min(low, points[i]);
                high = std::max(high, points[i]);
            }
            _middle[c] = low / 2 + high / 2;
            _reach[c] = 2 * (high - low);
            _largest = std::max({_largest, std::abs(low), std::abs(high)});
        }
    }

    double GetDiagonal() const { return std::hypot(_reach[0], _reach[1], _reach[2]) / 2; }

    /// \param rounding  relative, of what made the points
    template <class Number>
    bool Holds(std::span<Number const> points, double rounding) const {
        for (size_t i = 0; i < points.size(); ++i) {
            double const distance = std::abs(static_cast<double>(points[i]) - _middle[i % 3]);
            if (!(distance <= _reach[i % 3] + rounding * _largest)) return false;
        }
        return true;
    }

private:
    double _middle[3], _reach[3], _largest = 0.0;
};

void RequireInHull(Model const& model, std::vector<double> const& points) {
    Require(Hull(model.GetPositions()).Holds(std::span<double const>(points), 1e-9),
            "limits lie within four times the hull of the control points");
}

/// Requires that a result is a mesh again, of finite positions.
void RequireMesh(Scene scene) {
    Require(scene.positions.size() == 3 * static_cast<size_t>(scene.cage.numVertices),
            "a mesh has three coordinates per vertex");
    Require(AreFinite(scene.positions), "positions of a result are numbers");
    MustSucceed("a result is a mesh that can be read again",
                [&] { return Model::Build(std::move(scene)); });
}

void RequirePositions(Model const& model, std::vector<double> const& positions) {
    Require(positions.size() == model.GetPositions().size(), "a filter keeps every vertex");
    Require(AreFinite(positions), "positions of a result are numbers");
}

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

void Filter(Model const& model, Choices& choices, Job& job) {
    far_ext::LimitOptions const rule{.alpha = choices.Pick({0.0, 0.0, 0.5, 1.0})};
    int const kind = choices.TakeInt(0, 2);
    if (kind == 0) {
        engine::DenoiseOptions const options{choices.TakeInt(0, 4), choices.TakeInt(1, 3), rule};
        RequirePositions(model, engine::Denoise(model, options, job));
        return;
    }
    if (kind == 1) {
        int const first = choices.TakeInt(1, 4);
        engine::SharpenOptions const options{first, choices.TakeInt(first, 6),
                                             choices.TakeInt(1, 2), rule};
        RequirePositions(model, engine::Sharpen(model, options, job));
        return;
    }
    int const count = choices.TakeInt(1, 6);
    auto const bands = engine::SplitIntoBands(model, count, rule, job);
    Require(bands.bands.size() == static_cast<size_t>(count), "there are as many bands as asked");
    std::vector<double> sum = bands.remainder;
    double largest = 0.0;
    for (auto const& band : bands.bands) {
        for (size_t i = 0; i < sum.size(); ++i) {
            sum[i] += band[i];
            largest = std::max(largest, std::abs(band[i]));
        }
    }
    RequirePositions(model, sum);
    for (size_t i = 0; i < sum.size(); ++i) {
        Require(std::abs(sum[i] - model.GetPositions()[i]) <= 1e-12 * largest,
                "bands add up to the mesh");
    }
}

void MorphTo(Model const& model, Choices& choices, Job& job) {
    std::vector<double> positions = model.GetPositions();
    for (double& coordinate : positions) coordinate *= choices.Pick({1.0, 2.0, -1.0, 0.5});
    engine::MorphStep const step{choices.TakeInt(0, 3), choices.TakeShare()};
    engine::MorphOptions const options{.steps = std::vector<engine::MorphStep>(3, step)};
    engine::Morph morph(model, model.WithPoints(std::move(positions)), options);
    for (int frame = 0; frame < 3; ++frame) RequirePositions(model, morph.MakeNext(job));
}

engine::FilterWidths ChooseWidths(Model const& model, Choices& choices) {
    double const width = choices.Pick({0.1, 0.0, 0.5, 3.0});
    switch (choices.TakeInt(0, 3)) {
        case 1: {
            engine::VertexWidths widths;
            for (Index i = 0; i < model.GetCage().numVertices; ++i)
                widths.sigmas.push_back(choices.TakeShare());
            return widths;
        }
        case 2:
            return engine::MakeLocalWidths(model, width);
        case 3: {
            auto const& vertices = model.GetCage().faceVertices;
            return engine::EdgeWidths(model, {{{vertices[0], vertices[1]}, width}});
        }
        default:
            return engine::ConstantWidth{width};
    }
}

void Smooth(Model const& model, Choices& choices, Job& job) {
    engine::SmoothOptions options{.levels = choices.TakeInt(1, 2)};
    if (choices.TakeBool()) options.refinement = engine::SmoothRefinement::Bisect;
    if (choices.TakeBool()) options.boundary = far_ext::BoundaryRule::Natural;
    options.solver = choices.Pick({eval::CascadeSolver::ConjugateGradients,
                                   eval::CascadeSolver::Exact, eval::CascadeSolver::Jacobi});
    if (options.solver == eval::CascadeSolver::Jacobi) options.stop = engine::SweepsOnFinest{2};
    options.constraint =
        choices.Pick({engine::SmoothConstraint::None, engine::SmoothConstraint::Volume,
                      engine::SmoothConstraint::Graph});
    options.onCollapse = choices.Pick(
        {engine::OnCollapse::Stop, engine::OnCollapse::LimitWidth, engine::OnCollapse::KeepResult});
    options.keepsCreases = choices.TakeBool();
    if (choices.TakeOneIn(4)) options.precision = Precision::Float;
    auto const result = engine::Smooth(model, ChooseWidths(model, choices), options, job);
    if (result.mesh) RequireMesh(*result.mesh);
}

std::vector<engine::FieldStrength> ChooseStrengths(Choices& choices, Index numElements) {
    std::vector<engine::FieldStrength> strengths;
    for (int count = choices.TakeInt(0, 3); count > 0; --count) {
        Index const element = choices.TakeInt(0, numElements - 1);
        strengths.push_back({element, choices.Pick({1.0, -1.0, 0.25, 1e3})});
    }
    return strengths;
}

void Design(Model const& model, Choices& choices, Job& job) {
    engine::FieldOptions options;
    options.sources = ChooseStrengths(choices, model.GetCage().numVertices);
    options.vortices = ChooseStrengths(choices, model.GetCage().GetNumFaces());
    options.isBalanced = !choices.TakeOneIn(8);
    options.levels = choices.TakeInt(0, 2);
    if (choices.TakeBool()) options.atBoundary = eval::AtBoundary::Normal;
    for (int count = choices.TakeInt(0, 2); count > 0; --count) {
        bool const isFace = choices.TakeBool();
        Index const numElements =
            isFace ? model.GetCage().GetNumFaces() : model.GetCage().numVertices;
        Index const element = choices.TakeInt(0, numElements - 1);
        options.wanted.push_back({isFace, element, {1.0, choices.TakeSigned(), 0.0}});
    }
    auto const field = engine::DesignField(model, options, job);
    Require(AreFinite(field.form), "a form is made of numbers");
    for (auto const& vector : field.vectors) Require(AreFinite(vector), "vectors are numbers");
    for (auto const& vector : field.faceVectors) Require(AreFinite(vector), "vectors are numbers");
    RequireMesh(field.mesh);
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
        Bake,           Evaluate, Refine,  Fit,  Filter,    Smooth,   Design,
        MeasureSurface, Bake,     MorphTo, Bake, WeldTwice, Describe, RefineInDifferentialSpace};
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
