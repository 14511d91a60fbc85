// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "far_ext/enum_words.h"

namespace limn::cli {

enum class Shell { Bash, Zsh, Fish };

inline constexpr auto kShellWords = MakeEnumWords<Shell>(
    "shell", {{Shell::Bash, "bash"}, {Shell::Zsh, "zsh"}, {Shell::Fish, "fish"}});

/// A script after which a shell completes the verbs of this command line, their options, the words
/// these take, and files.
std::string WriteCompletion(CLI::App const& app, Shell shell);

std::string WriteBashCompletion(CLI::App const& app);
std::string WriteZshCompletion(CLI::App const& app);
std::string WriteFishCompletion(CLI::App const& app);

}  // namespace limn::cli
