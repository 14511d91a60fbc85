// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "eval/stencils/table_evaluator.h"
#include "far_ext/types.h"

namespace limn::cli {

/// Adds --evaluator. \param what  the tables that it applies, for the help
CLI::Option* AddEvaluatorOption(CLI::App& verb, std::optional<eval::EvaluatorKind>& kind,
                                std::string const& what);

/// The evaluator of a run; none where none was asked for.
///
/// \param precision  of the files, if one was asked for
/// \throws Error     BadOption: double; an evaluator that is not built in
std::unique_ptr<eval::TableEvaluator> MakeEvaluator(std::optional<eval::EvaluatorKind> kind,
                                                    std::optional<Precision> precision);

/// Adds `evaluator`: what was applied, and how often. Nothing without one.
void AddToReport(nlohmann::json& report, eval::TableEvaluator const* evaluator);

}  // namespace limn::cli
