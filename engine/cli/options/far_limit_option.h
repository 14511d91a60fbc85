// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "engine/evaluate/far_limit.h"

namespace limn::cli {

/// Whose limit stencils.
enum class LimitStencils { Exact, Far };

inline constexpr auto kLimitStencilsWords = MakeEnumWords<LimitStencils>(
    "limitStencils", {{LimitStencils::Exact, "exact"}, {LimitStencils::Far, "far"}});

/// What --limit-stencils and the flags behind it say.
struct FarLimitArguments {
    LimitStencils stencils = LimitStencils::Exact;
    engine::FarLimitRule rule;
    std::optional<eval::EvaluatorKind> evaluator;

    /// Nothing where the limit is the exact one.
    std::optional<engine::FarLimitRule> GetRule() const;
};

/// \param what  is done with them, for the help
void AddFarLimitOptions(CLI::App& verb, FarLimitArguments& arguments, char const* what);

/// Refuses flags that change nothing without --limit-stencils far. \throws Error BadOption
void RefuseWithoutFarLimit(CLI::App const& verb, FarLimitArguments const& arguments);

/// The report's `far`.
nlohmann::json DescribeFarLimit(engine::FarReport const& report);

}  // namespace limn::cli
