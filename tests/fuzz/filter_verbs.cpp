// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "engine/fit/band_sum.h"
#include "engine/fit/bands.h"
#include "engine/fit/combine.h"
#include "engine/fit/morph.h"
#include "fuzz/fuzzer.h"
#include "fuzz/promises.h"
#include "fuzz/verbs.h"

namespace limn::fuzz {

using engine::Job;
using engine::Model;

namespace {

constexpr double kGains[] = {1.0, 0.0, 2.0, -1.0, 0.5, 1e3};

/// The mesh, perhaps otherwise posed.
Model ChoosePose(Model const& model, Choices& choices) {
    std::vector<double> positions = model.GetPositions();
    double const scale = choices.Pick({1.0, 2.0, -1.0, 0.0});
    bool const isBent = choices.TakeBool();
    for (size_t i = 0; i < positions.size(); ++i) {
        positions[i] *= scale;
        if (isBent) positions[i] += choices.TakeSigned() * std::abs(positions[i]);
    }
    return model.WithPoints(std::move(positions));
}

engine::Carry ChooseCarry(Choices& choices) {
    return choices.Pick({engine::Carry::Local, engine::Carry::Object});
}

}  // namespace

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

void SumBands(Model const& model, Choices& choices, Job& job) {
    engine::BandSumOptions options{.gains = {.first = choices.TakeInt(0, 3)}};
    for (int count = choices.TakeInt(1, 4); count > 0; --count)
        options.gains.gains.push_back(choices.Pick(kGains));
    options.gains.remainder = choices.Pick(kGains);
    if (choices.TakeOneIn(4)) options.gains.remainder.reset();
    options.carry = ChooseCarry(choices);
    options.rule.alpha = choices.Pick({0.0, 0.0, 0.5, 1.0});
    bool const isOwn = choices.TakeBool();
    if (!isOwn) options.from = ChoosePose(model, choices);
    auto const sum = engine::SumBands(model, options, job);
    RequirePositions(model, sum.positions);
    bool const isPlain =
        isOwn && options.gains.first == 0 && options.gains.remainder == 1.0 &&
        std::ranges::count(options.gains.gains, 1.0) == std::ssize(options.gains.gains);
    double largest = 0.0;
    for (auto const& part : sum.parts) {
        Require(std::isfinite(part.rms) && part.rms >= 0.0, "a band has a length");
        largest = std::max(largest, part.rms);
    }
    largest *= std::sqrt(static_cast<double>(sum.positions.size()));
    for (size_t i = 0; isPlain && i < sum.positions.size(); ++i) {
        Require(std::abs(sum.positions[i] - model.GetPositions()[i]) <= 1e-12 * largest,
                "bands of gain 1 add up to the mesh");
    }
}

void Combine(Model const& model, Choices& choices, Job& job) {
    engine::CombineOptions options{.scale = choices.Pick(kGains)};
    for (int count = choices.TakeInt(0, 2); count > 0; --count)
        options.added.push_back({ChoosePose(model, choices), choices.Pick(kGains)});
    for (int count = choices.TakeInt(0, 2); count > 0; --count)
        options.offsets.push_back(
            {ChoosePose(model, choices), ChoosePose(model, choices), choices.Pick(kGains)});
    options.carry = ChooseCarry(choices);
    auto const combined = engine::Combine(model, options, job);
    RequireMesh(combined.mesh);
    Require(AreFinite(std::initializer_list<double>{combined.maxOffset, combined.rmsOffset,
                                                    combined.largestTurnDegrees}),
            "offsets are numbers");
    Require(combined.rmsOffset <= combined.maxOffset * (1.0 + 1e-9),
            "no mean is above the largest");
}

}  // namespace limn::fuzz
