// SPDX-License-Identifier: Apache-2.0
#include "engine/fit/band_sum.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/scene/same_faces.h"
#include "far_ext/error.h"
#include "far_ext/option_checks.h"

namespace limn::engine {

namespace {

double FindRms(std::span<double const> vectors) {
    double squares = 0.0;
    for (double x : vectors) squares += x * x;
    double const count = std::max(1.0, static_cast<double>(vectors.size()) / 3.0);
    return std::sqrt(squares / count);
}

/// The same bands, as they are.
eval::BandGains WithoutGains(eval::BandGains gains) {
    std::ranges::fill(gains.gains, 1.0);
    if (gains.remainder) gains.remainder = 1.0;
    return gains;
}

/// The weighed bands of some positions, which are told of in `parts`.
std::vector<double> TakeBands(eval::LimitApplication const& A, eval::BandGains const& gains,
                              std::vector<double> positions, std::vector<BandSum::Part>& parts,
                              Job& job) {
    eval::WeighBands(A, 3, gains, positions, [&](int i, std::span<double const> band) {
        job.CheckStopped();
        if (i < gains.first) return;
        if (i < gains.GetEnd())
            parts.push_back({i, FindRms(band), gains.gains[i - gains.first]});
        else
            parts.push_back({{}, FindRms(band), *gains.remainder});
    });
    return positions;
}

}  // namespace

void BandSumOptions::Check() const {
    if (gains.first < 0) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("there is no band {}; they begin at 0", gains.first));
    }
    RequireAllFinite("gains", gains.gains);
    if (gains.remainder) RequireFinite("gains", *gains.remainder, "of the remainder: ");
    RequireKnown(kCarryWords, carry);
}

BandSum SumBands(Model const& model, BandSumOptions const& options, Job& job) {
    options.Check();
    if (options.from) RequireSameFaces(model, *options.from, "a sum of bands");
    job.Start("building the limit matrix");
    auto const A =
        eval::LimitApplication::Build(model.GetRefiner(), options.rule, options.evaluator);
    job.Start("filtering");
    BandSum sum;
    Model const& source = options.from ? *options.from : model;
    sum.positions = TakeBands(A, options.gains, source.GetPositions(), sum.parts, job);
    if (!options.from) return sum;

    sum.largestTurnDegrees = CarryVectors(options.carry, A, model.GetLevel(), source.GetPositions(),
                                          model.GetPositions(), sum.positions, job);
    std::vector<double> replaced = model.GetPositions();
    eval::WeighBands(A, 3, WithoutGains(options.gains), replaced,
                     [&](int, std::span<double const>) { job.CheckStopped(); });
    for (size_t i = 0; i < sum.positions.size(); ++i)
        sum.positions[i] += model.GetPositions()[i] - replaced[i];
    return sum;
}

}  // namespace limn::engine
