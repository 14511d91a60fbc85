// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/options/far_limit_option.h"

#include <fmt/format.h>

#include "engine/cli/options/number_option.h"
#include "engine/cli/options/option_rules.h"
#include "engine/cli/options/word_option.h"

namespace limn::cli {

namespace {

nlohmann::json Describe(engine::LimitDifference const& difference,
                        engine::PlaceArrays const& places) {
    nlohmann::json json{{"max", difference.max},
                        {"rms", difference.rms},
                        {"p99", difference.p99},
                        {"median", difference.median}};
    if (places.faces.empty()) return json;
    json["face"] = places.faces[difference.place];
    json["s"] = places.s[difference.place];
    json["t"] = places.t[difference.place];
    return json;
}

}  // namespace

std::optional<engine::FarLimitRule> FarLimitArguments::GetRule() const {
    if (stencils == LimitStencils::Exact) return std::nullopt;
    engine::FarLimitRule wanted = rule;
    wanted.evaluator = evaluator.value_or(rule.evaluator);
    return wanted;
}

void AddFarLimitOptions(CLI::App& verb, FarLimitArguments& arguments, char const* what) {
    AddWordOption(verb, "--limit-stencils", arguments.stencils, kLimitStencilsWords,
                  fmt::format("far: OpenSubdiv's table, in float, {}; the report's `far` says how "
                              "far it is from the exact limit",
                              what));
    AddNumberOption(verb, "--far-level", arguments.rule.options.level,
                    "of far: to which level features are isolated (default 6)",
                    {1, far_ext::FarLimitOptions::kMaxLevel});
    AddWordOption(verb, "--far-end-cap", arguments.rule.options.endCap, far_ext::kEndCapWords,
                  "of far: what closes the hole that isolation leaves");
    verb.add_flag("--far-inf-sharp", arguments.rule.options.hasInfSharpPatches,
                  "of far: patches of their own along infinitely sharp creases");
}

void RefuseWithoutFarLimit(CLI::App const& verb, FarLimitArguments const& arguments) {
    if (arguments.stencils == LimitStencils::Far) return;
    RefuseEach(verb, {"--far-level", "--far-end-cap", "--far-inf-sharp"},
               "needs --limit-stencils far");
}

nlohmann::json DescribeFarLimit(engine::FarReport const& report) {
    auto const& [rule, places, far, comparison] = report;
    auto const describe = [&](engine::LimitDifference const& difference) {
        return Describe(difference, places.GetPlaces());
    };
    return {{"level", rule.options.level},
            {"end_cap", far_ext::kEndCapWords.GetWord(rule.options.endCap)},
            {"inf_sharp", rule.options.hasInfSharpPatches},
            {"evaluator", GetName(rule.evaluator)},
            {"places", comparison.numPlaces},
            {"table_bytes", far.tableBytes},
            {"build_seconds", far.buildSeconds},
            {"position", describe(comparison.position)},
            {"normal_degrees", describe(comparison.normalDegrees)},
            {"mean_curvature", describe(comparison.meanCurvature)}};
}

}  // namespace limn::cli
