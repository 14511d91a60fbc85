// SPDX-License-Identifier: Apache-2.0
#include "engine/fit/combine.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/scene/same_faces.h"
#include "far_ext/option_checks.h"
#include "far_ext/rows/points.h"

namespace limn::engine {

namespace {

void Add(double weight, std::vector<double> const& from, std::vector<double>& to) {
    for (size_t i = 0; i < to.size(); ++i) to[i] += weight * from[i];
}

Primvar const* FindScalar(Model const& model, std::string const& name) {
    auto const& primvars = model.GetPrimvars();
    auto const found = std::ranges::find(primvars, name, &Primvar::name);
    return found == primvars.end() || found->numChannels != 1 ? nullptr : &*found;
}

/// Adds up a primvar that is a scalar of all meshes; others stay.
void CombineScalar(CombineOptions const& options, Primvar& primvar) {
    if (primvar.numChannels != 1) return;
    std::vector<double> sum(primvar.values.begin(), primvar.values.end());
    for (double& value : sum) value *= options.scale;
    for (WeightedMesh const& added : options.added) {
        Primvar const* const other = FindScalar(added.mesh, primvar.name);
        if (!other) return;
        Add(added.weight, {other->values.begin(), other->values.end()}, sum);
    }
    std::ranges::transform(sum, primvar.values.begin(),
                           [](double x) { return static_cast<float>(x); });
}

/// R (B - A) for all offsets, weighed and added up. \return the largest turn
double AddOffsets(Model const& model, CombineOptions const& options, std::vector<double>& sum,
                  Job& job) {
    if (options.offsets.empty()) return 0.0;
    job.Start("building the limit matrix");
    eval::LimitApplication const A = eval::LimitOperator::Build(model.GetRefiner());
    double largestTurn = 0.0;
    for (auto const& [from, to, weight] : options.offsets) {
        std::vector<double> offset = to.GetPositions();
        Add(-1.0, from.GetPositions(), offset);
        double const turn = CarryVectors(options.carry, A, model.GetLevel(), from.GetPositions(),
                                         model.GetPositions(), offset, job);
        largestTurn = std::max(largestTurn, turn);
        Add(weight, offset, sum);
    }
    return largestTurn;
}

void MeasureOffset(Model const& model, Combination& result) {
    far_ext::Points const before(model.GetPositions()), after(result.mesh.positions);
    double squares = 0.0;
    for (size_t i = 0; i < before.GetCount(); ++i) {
        double const square = (after[i] - before[i]).squaredNorm();
        squares += square;
        result.maxOffset = std::max(result.maxOffset, std::sqrt(square));
    }
    double const count = std::max(1.0, static_cast<double>(before.GetCount()));
    result.rmsOffset = std::sqrt(squares / count);
}

/// Finite summands may add up beyond the range of their numbers.
template <class Number>
void RefuseOverflow(Model const& model, std::string const& what, std::vector<Number> const& sum) {
    auto const bad = std::ranges::find_if_not(sum, [](Number x) { return std::isfinite(x); });
    if (bad == sum.end()) return;
    throw Error(ErrorCode::TooLarge,
                fmt::format("{}: {} of the combination are beyond the range "
                            "of {}; weights nearer to 1 keep them within",
                            model.GetPath(), what, sizeof(Number) == 4 ? "float" : "double"));
}

}  // namespace

void CombineOptions::Check() const {
    RequireFinite("scale", scale);
    for (WeightedMesh const& mesh : added) RequireFinite("added", mesh.weight, "the weight ");
    for (WeightedOffset const& offset : offsets)
        RequireFinite("offsets", offset.weight, "the weight ");
    RequireKnown(kCarryWords, carry);
}

Combination Combine(Model const& model, CombineOptions const& options, Job& job) {
    options.Check();
    char const* const purpose = "a combination";
    for (WeightedMesh const& added : options.added) RequireSameFaces(model, added.mesh, purpose);
    for (WeightedOffset const& offset : options.offsets) {
        RequireSameFaces(model, offset.from, purpose);
        RequireSameFaces(model, offset.to, purpose);
    }
    Combination result;
    result.mesh = model.MakeScene();
    std::vector<double>& sum = result.mesh.positions;
    for (double& coordinate : sum) coordinate *= options.scale;
    for (WeightedMesh const& added : options.added)
        Add(added.weight, added.mesh.GetPositions(), sum);
    if (!options.added.empty()) {
        for (Primvar& primvar : result.mesh.primvars) CombineScalar(options, primvar);
    }
    result.largestTurnDegrees = AddOffsets(model, options, sum, job);
    RefuseOverflow(model, "coordinates", sum);
    for (Primvar const& primvar : result.mesh.primvars)
        RefuseOverflow(model, fmt::format("values of '{}'", primvar.name), primvar.values);
    MeasureOffset(model, result);
    return result;
}

std::vector<Primvar> MakeOffsetPrimvars(std::string const& name, Model const& model,
                                        std::vector<double> const& positions) {
    if (positions.size() != model.GetPositions().size()) {
        RefuseOption("positions",
                     fmt::format("{} numbers; {} has {} vertices, of 3 each", positions.size(),
                                 model.GetPath(), model.GetPositions().size() / 3));
    }
    std::vector<Primvar> primvars;
    for (size_t axis = 0; axis < 3; ++axis) {
        Primvar primvar{name + "xyz" [axis], 1, {}};
        for (size_t i = axis; i < positions.size(); i += 3)
            primvar.values.push_back(static_cast<float>(positions[i] - model.GetPositions()[i]));
        primvars.push_back(std::move(primvar));
    }
    return primvars;
}

}  // namespace limn::engine
