// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "engine/cli/cli.h"
#include "engine/fit/bands.h"

namespace limn::cli {

/// What bands, denoise, sharpen and morph have in common: --alpha, and a report of sizes.
struct FilterOptions {
    double alpha = 0.0;

    void AddTo(CLI::App& verb) {
        verb.add_option("--alpha", alpha,
                        "generalised Catmull-Clark in the first step, 0 (default) to 1")
            ->check(CLI::Range(0.0, 1.0));
    }
    eval::LimitOperator Build(Context::Mesh const& mesh) const {
        return eval::LimitOperator::Build(*mesh.refiner, 0, {.alpha = alpha});
    }
};

/// {"volume": ..., "bounding_box": [[x,y,z],[x,y,z]]}, volume null where open.
inline nlohmann::json DescribeExtent(engine::Scene const& scene, Context::Mesh const& mesh) {
    auto const extent = engine::MeasureExtent(scene, mesh.refiner->GetLevel(0));
    nlohmann::json json{{"volume", nullptr}, {"bounding_box", {extent.low, extent.high}}};
    if (extent.volume) json["volume"] = *extent.volume;
    return json;
}

inline void WarnAll(Context& context, std::vector<std::string> const& warnings) {
    for (std::string const& warning : warnings) context.GetJob().Warn(warning);
}

}  // namespace limn::cli
