// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace limn::cli {

/// What the floors below call an option, and how the command line spells it.
struct OptionName {
    std::string_view member;  ///< of an options struct, or a function's argument
    std::string_view flag;    ///< with its value, where the member stands for one
};

/// All members that messages of the floors below name.
std::span<OptionName const> GetOptionNames();

/// A message of the floors below, which put members in backquotes, in the command line's words:
/// "`levels`: 11 is not from 0 to 10" becomes "--levels: 11 is not from 0 to 10". What is not in
/// the table stays as it is.
std::string NameFlags(std::string_view message);

}  // namespace limn::cli
