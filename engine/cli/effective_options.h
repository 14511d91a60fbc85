// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

namespace limn::cli {

/// What the options of verbs are where nobody gives them.
using OptionDefaults = std::map<CLI::Option const*, std::string>;

/// Takes the captured defaults of a verb's options away from it: its help says them in words.
void TakeDefaults(CLI::App& verb, OptionDefaults& defaults);

/// The value of every option of a verb that was parsed, by its long name: numbers, truths, lists
/// and words. null where limn chooses.
nlohmann::json DescribeOptions(CLI::App const& verb, OptionDefaults const& defaults);

}  // namespace limn::cli
