// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/options/evaluator_option.h"

#include <fmt/format.h>

#include "engine/cli/options/word_option.h"
#include "far_ext/error.h"

namespace limn::cli {

CLI::Option* AddEvaluatorOption(CLI::App& verb, std::optional<eval::EvaluatorKind>& kind,
                                std::string const& what) {
    return AddWordOption(
        verb, "--evaluator", kind, eval::kEvaluatorWords,
        fmt::format("apply {} in float: simd (limn's), osd-cpu or osd-omp (OpenSubdiv's); "
                    "the report's `evaluator` counts them",
                    what));
}

std::unique_ptr<eval::TableEvaluator> MakeEvaluator(std::optional<eval::EvaluatorKind> kind,
                                                    std::optional<Precision> precision) {
    if (!kind) return nullptr;
    if (!eval::IsBuiltIn(*kind)) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("--evaluator {}: this OpenSubdiv was built without OpenMP",
                                eval::GetName(*kind)));
    }
    if (precision == Precision::Double) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("--evaluator {} works in float; --precision double excludes it",
                                eval::GetName(*kind)));
    }
    return std::make_unique<eval::TableEvaluator>(*kind);
}

void AddToReport(nlohmann::json& report, eval::TableEvaluator const* evaluator) {
    if (!evaluator) return;
    nlohmann::json tables = nlohmann::json::array();
    for (eval::TableUse const& use : evaluator->GetUses()) {
        tables.push_back({{"what", use.what},
                          {"rows", use.rows},
                          {"entries", use.entries},
                          {"applications", use.applications},
                          {"seconds", use.seconds}});
    }
    report["evaluator"] = {{"name", eval::GetName(evaluator->GetKind())},
                           {"tables", std::move(tables)}};
}

}  // namespace limn::cli
