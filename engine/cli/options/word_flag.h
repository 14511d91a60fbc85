// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace limn::cli {

/// A flag that one of a few words may follow: "--picture", "--picture gaussian".
///
/// \param target  the word, "true" without one, empty without the flag; outlives the verb. Typed
///                with '=' it may be any word
CLI::Option* AddWordFlag(CLI::App& verb, std::string const& flag, std::string& target,
                         std::vector<std::string> const& words, std::string const& help);

/// The words of a command line with those that belong to such a flag joined to it by '='. A flag
/// takes no other word, so that a file may stand behind it.
std::vector<std::string> JoinWordFlags(CLI::App const& verb, std::vector<std::string> words);

}  // namespace limn::cli
