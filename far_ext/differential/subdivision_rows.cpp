// SPDX-License-Identifier: Apache-2.0
#include "far_ext/differential/subdivision_rows.h"

#include <fmt/format.h>
#include <opensubdiv/far/primvarRefiner.h>

#include "far_ext/differential/butterfly.h"
#include "far_ext/differential/interpolating.h"
#include "far_ext/differential/kobbelt.h"
#include "far_ext/error.h"

namespace limn::far_ext {

namespace {

SparseRows Join(std::vector<WeightRow> const& rows) {
    SparseRows joined;
    for (WeightRow const& row : rows) joined.AddRow(row);
    return joined;
}

SparseRows BuildSchemeRows(Far::TopologyRefiner const& refiner, int level) {
    auto const coarse = WeightRow::Identity(refiner.GetLevel(level - 1).GetNumVertices());
    std::vector<WeightRow> fine(refiner.GetLevel(level).GetNumVertices());
    Far::PrimvarRefinerReal<double>(refiner).Interpolate(level, coarse, fine);
    return Join(fine);
}

struct TensionRange {
    double standard, highest;
};

TensionRange GetTensionRange(SubdivisionRule rule) {
    switch (rule) {
        case SubdivisionRule::OriginalButterfly:
            return {1.0 / 16, 1.0 / 8};
        case SubdivisionRule::Kobbelt:
            return {1.0, 2.0};
        default:
            return {0.0, 0.0};
    }
}

}  // namespace

void CheckTension(TunedRule const& rule) {
    if (!rule.tension) return;
    double const tension = *rule.tension, highest = GetTensionRange(rule.rule).highest;
    if (!(highest > 0.0)) {
        throw Error(ErrorCode::BadOption,
                    "`tension`: only `rule` butterfly-original and kobbelt have one; leave it out");
    }
    if (tension >= 0.0 && tension <= highest) return;
    throw Error(ErrorCode::BadOption, fmt::format("`tension`: {} is not from 0 to {}, what this "
                                                  "`rule` takes",
                                                  tension, highest));
}

SparseRows BuildSubdivisionRows(Far::TopologyRefiner const& refiner, int level,
                                TunedRule const& rule) {
    CheckTension(rule);
    double const tension = rule.tension.value_or(GetTensionRange(rule.rule).standard);
    switch (rule.rule) {
        case SubdivisionRule::Butterfly:
            return BuildButterfly(refiner, level);
        case SubdivisionRule::OriginalButterfly:
            return BuildOriginalButterfly(refiner, level, tension);
        case SubdivisionRule::Kobbelt:
            return BuildKobbelt(refiner, level, tension);
        case SubdivisionRule::Interpolating:
            return DeduceInterpolatingRows(refiner, level, BuildSchemeRows(refiner, level));
        case SubdivisionRule::Scheme:
            break;
    }
    return BuildSchemeRows(refiner, level);
}

SparseRows BuildFVarSubdivisionRows(Far::TopologyRefiner const& refiner, int level, int channel) {
    auto const coarse = WeightRow::Identity(refiner.GetLevel(level - 1).GetNumFVarValues(channel));
    std::vector<WeightRow> fine(refiner.GetLevel(level).GetNumFVarValues(channel));
    Far::PrimvarRefinerReal<double>(refiner).InterpolateFaceVarying(level, coarse, fine, channel);
    return Join(fine);
}

}  // namespace limn::far_ext
