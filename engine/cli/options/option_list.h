// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace limn::cli {

/// The group of the options that every verb has.
inline constexpr char const* kCommonGroup = "Options every verb shares";

/// What completion and the manual need to know of an option, or of what stands without one.
struct OptionEntry {
    enum class Value { None, Number, Words, Other };

    std::string shortFlag, longFlag;  ///< "-o", "--output"; both empty for a positional
    std::string placeholder;          ///< "INT from 0 to 10"; the name of a positional
    std::string help, group;
    Value value = Value::None;
    std::vector<std::string> words{};  ///< that it takes: all there are, or some among others
    bool isList = false;               ///< separated by commas

    bool IsPositional() const { return shortFlag.empty() && longFlag.empty(); }
    bool IsCommon() const { return group == kCommonGroup; }

    /// True for a flag that a word may follow, behind '=': "--half=normal".
    bool IsFlagWithWords() const { return value == Value::None && !words.empty(); }

    /// "-o, --output"
    std::string JoinFlags() const;
};

/// One option.
OptionEntry MakeOptionEntry(CLI::Option const& option);

/// The options of limn or of a verb, in the order of its help.
std::vector<OptionEntry> ListOptions(CLI::App const& app);

/// All verbs, those that tell of limn itself included.
std::vector<CLI::App const*> ListVerbs(CLI::App const& app);

/// The options that every verb has.
std::vector<OptionEntry> ListCommonOptions(CLI::App const& app);

/// All flags of these: "-o", "--output", ...
std::vector<std::string> ListFlags(std::vector<OptionEntry> const& options);

}  // namespace limn::cli
