// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "engine/cli/cli.h"
#include "engine/cli/names.h"
#include "engine/cli/options/evaluator_option.h"
#include "engine/cli/options/number_option.h"
#include "engine/cli/options/word_option.h"
#include "engine/fit/bands.h"
#include "engine/io/mesh_writer.h"

namespace limn::cli {

// What bands, denoise, sharpen, morph and fit have in common: --alpha, --evaluator, and a report of
// sizes.

inline constexpr auto kAlphaRuleWords = MakeEnumWords<far_ext::LimitOptions::AlphaRule>(
    "alphaRule", {{far_ext::LimitOptions::AlphaRule::FirstStep, "first"},
                  {far_ext::LimitOptions::AlphaRule::Stationary, "stationary"}});

/// \param alpha  the option whose rule it is
inline void AddAlphaRule(CLI::App& verb, far_ext::LimitOptions::AlphaRule& rule,
                         CLI::Option* alpha) {
    AddWordOption(verb, "--alpha-rule", rule, kAlphaRuleWords,
                  "first (default): alpha in the first step, plain Catmull-Clark afterwards; "
                  "stationary: alpha in every step")
        ->needs(alpha);
}

inline void AddAlpha(CLI::App& verb, far_ext::LimitOptions& rule) {
    auto* const alpha = AddNumberOption(verb, "--alpha", rule.alpha,
                                        "generalised Catmull-Clark, 0 (default) to 1", {0.0, 1.0});
    AddAlphaRule(verb, rule.alphaRule, alpha);
}

/// {"volume": ..., "bounding_box": [[x,y,z],[x,y,z]]}, volume null where open.
inline nlohmann::json DescribeExtent(engine::Model const& model,
                                     std::vector<double> const& positions) {
    auto const extent = engine::MeasureExtent(model, positions);
    nlohmann::json json{{"volume", nullptr}, {"bounding_box", {extent.low, extent.high}}};
    if (extent.volume) json["volume"] = *extent.volume;
    return json;
}

/// The same of one of several files.
inline nlohmann::json DescribeOutput(std::string const& path, engine::Model const& model,
                                     std::vector<double> const& positions, Precision precision) {
    auto json = DescribeExtent(model, positions);
    json["file"] = path;
    json["mesh"] = model.GetPath();
    json["precision_written"] = kPrecisionWords.GetWord(precision);
    return json;
}

/// Writes what has become of a model, and reports its extent as it is written.
inline void WriteFiltered(std::string const& path, engine::Model const& model, engine::Scene output,
                          Context& context) {
    Precision const precision = context.ChoosePrecision(path, output.positions);
    engine::RoundAsWritten(path, precision, output.positions);
    context.GetReport()["after"] = DescribeExtent(model, output.positions);
    context.WriteMesh(path, output, precision);
}

/// The same of a model with other positions.
inline void WriteFiltered(std::string const& path, engine::Model const& model,
                          std::vector<double> positions, Context& context) {
    engine::Scene output = model.MakeScene();
    output.positions = std::move(positions);
    WriteFiltered(path, model, std::move(output), context);
}

}  // namespace limn::cli
