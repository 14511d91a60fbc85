// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "engine/cli/cli.h"
#include "engine/cli/names.h"
#include "engine/cli/options/number_option.h"
#include "engine/fit/bands.h"

namespace limn::cli {

// What bands, denoise, sharpen and morph have in common: --alpha, and a report of sizes.

inline void AddAlpha(CLI::App& verb, double& alpha) {
    AddNumberOption(verb, "--alpha", alpha,
                    "generalised Catmull-Clark in the first step, 0 (default) to 1", {0.0, 1.0});
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

}  // namespace limn::cli
