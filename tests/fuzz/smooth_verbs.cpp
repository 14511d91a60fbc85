// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include "engine/smooth/smooth.h"
#include "fuzz/fuzzer.h"
#include "fuzz/promises.h"
#include "fuzz/verbs.h"

namespace limn::fuzz {

using engine::Job;
using engine::Model;

namespace {

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

/// Smoothing in steps, without refinement or where it is needed.
void ChooseFairing(Choices& choices, engine::SmoothOptions& options) {
    if (choices.TakeOneIn(3)) options.levels = 0;
    if (choices.TakeOneIn(3)) options.steps = choices.TakeInt(1, 3);
    if (choices.TakeOneIn(3)) options.settle = choices.Pick({1e-3, 1e-6, 0.1});
    if (choices.TakeOneIn(3)) options.order = 4;
    if (choices.TakeOneIn(3)) options.keptFeatures = choices.Pick({1.0, 0.1, 10.0, 1e-6});
    if (choices.TakeOneIn(3)) options.adaptive = choices.Pick({0.05, 0.01, 0.3, 1e-4});
}

}  // namespace

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
    auto const widths = ChooseWidths(model, choices);
    ChooseFairing(choices, options);
    auto const result = engine::Smooth(model, widths, options, job);
    if (result.mesh) RequireMesh(*result.mesh);
    for (double const move : result.report.settleMoves)
        Require(std::isfinite(move) && move >= 0.0, "a move has a length");
    Require(!result.report.criticalFactor ||
                (*result.report.criticalFactor >= 0.0 && *result.report.criticalFactor <= 1.0),
            "the critical width is a share of the width");
}

}  // namespace limn::fuzz
