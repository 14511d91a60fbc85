// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/field/field.h"
#include "engine/field/streamlines.h"
#include "fuzz/fuzzer.h"
#include "fuzz/promises.h"
#include "fuzz/verbs.h"

namespace limn::fuzz {

using engine::Job;
using engine::Model;

namespace {

std::vector<engine::FieldStrength> ChooseStrengths(Choices& choices, Index numElements) {
    std::vector<engine::FieldStrength> strengths;
    for (int count = choices.TakeInt(0, 3); count > 0; --count) {
        Index const element = choices.TakeInt(0, numElements - 1);
        strengths.push_back({element, choices.Pick({1.0, -1.0, 0.25, 1e3})});
    }
    return strengths;
}

/// Parts that fields may have besides sources, vortices and vectors.
void ChooseFurtherParts(Model const& model, Choices& choices, engine::FieldOptions& options) {
    Index const numVertices = model.GetCage().numVertices, numFaces = model.GetCage().GetNumFaces();
    if (choices.TakeOneIn(4)) {
        auto& values = options.values.emplace();
        for (Index i = 0; i < numVertices; ++i) values.push_back(choices.TakeSigned());
    }
    if (choices.TakeOneIn(4)) {
        for (int count = choices.TakeInt(1, 3); count > 0; --count)
            options.pins.push_back({choices.TakeInt(0, numVertices - 1), choices.TakeSigned()});
    }
    if (choices.TakeOneIn(4)) {
        auto& integrals = options.integrals.emplace();
        for (Index i = 0; i < numFaces; ++i) integrals.push_back(choices.TakeSigned());
    }
    if (choices.TakeOneIn(4)) {
        for (int count = choices.TakeInt(1, 3); count > 0; --count)
            options.singularities.push_back(
                {choices.TakeInt(0, numVertices - 1), choices.Pick({1, -1, 2})});
    }
    if (choices.TakeOneIn(4)) options.harmonics = {choices.TakeSigned(), choices.TakeSigned()};
}

void ChooseBoundaryData(Model const& model, Choices& choices, engine::FieldOptions& options) {
    if (!choices.TakeOneIn(3)) return;
    Index const numVertices = model.GetCage().numVertices,
                numEdges = model.GetLevel().GetNumEdges();
    for (int count = choices.TakeInt(0, 2); count > 0; --count)
        options.loops.push_back({choices.TakeInt(0, numVertices - 1), choices.TakeBool(),
                                 choices.Pick({0.0, 1.0, -1.0, 100.0})});
    for (int count = choices.TakeInt(0, 4); count > 0; --count)
        options.boundaryEdges.push_back(
            {choices.TakeInt(0, numEdges - 1), choices.TakeBool(), choices.TakeSigned()});
    for (int count = choices.TakeInt(0, 2); count > 0; --count)
        options.arcFluxes.push_back({choices.TakeInt(0, numVertices - 1), choices.TakeSigned()});
}

}  // namespace

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
    ChooseFurtherParts(model, choices, options);
    ChooseBoundaryData(model, choices, options);
    auto const field = engine::DesignField(model, options, job);
    Require(AreFinite(field.form), "a form is made of numbers");
    for (auto const& vector : field.vectors) Require(AreFinite(vector), "vectors are numbers");
    for (auto const& vector : field.faceVectors) Require(AreFinite(vector), "vectors are numbers");
    RequireMesh(field.mesh);
    Require(field.audit.commutationD0 < 1e-9 && field.audit.commutationD1 < 1e-9,
            "subdivision and the operators d commute");
    if (!field.audit.boundary) return;
    for (auto const& loop : field.audit.boundary->loops)
        Require(AreFinite(std::initializer_list<double>{loop.circulation, loop.flux}),
                "what flows along and out of a boundary is a number");
}

void DrawLines(Model const& model, Choices& choices, Job& job) {
    std::vector<double> form;
    for (Index edge = 0; edge < model.GetLevel().GetNumEdges(); ++edge)
        form.push_back(choices.TakeSigned());
    double const size = Hull(model.GetPositions()).GetDiagonal();
    engine::StreamlineOptions options{.isForwardOnly = choices.TakeBool()};
    std::vector<Index> faces;
    std::vector<double> s, t;
    if (choices.TakeBool()) {
        for (int count = choices.TakeInt(1, 4); count > 0; --count) {
            faces.push_back(choices.TakeInt(0, model.GetCage().GetNumFaces() - 1));
            s.push_back(choices.Pick({0.0, 0.5, 1.0, 0.3}));
            t.push_back(choices.Pick({0.0, 0.5, 0.25}));
        }
        options.seeds = {faces, s, t};
        options.maxLength = size;
    }
    if (!options.seeds || choices.TakeBool())
        options.separation = size * choices.Pick({0.25, 0.1, 1.0});
    if (choices.TakeOneIn(4)) options.step = size * choices.Pick({0.02, 0.1});
    auto const drawn = engine::TraceStreamlines(model, form, options, job);
    Hull const hull(model.GetPositions());
    for (auto const& line : drawn.lines) {
        Require(!line.points.empty() && std::isfinite(line.length), "a line has points");
        for (auto const& point : line.points) {
            Require(hull.Holds(std::span<double const>(point.position.data(), 3), 1e-9),
                    "lines lie where limits can");
        }
    }
}

}  // namespace limn::fuzz
