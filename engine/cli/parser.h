// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/cli/cli.h"
#include "engine/cli/effective_options.h"
#include "engine/cli/terminal/completion.h"

namespace limn::cli {

/// The command line: limn's verbs and their options.
class Parser {
public:
    Parser();
    Parser(Parser const&) = delete;
    Parser& operator=(Parser const&) = delete;

    /// \return        what to print, where that is all that was asked for (help, version, ...)
    /// \throws Error  BadOption
    std::optional<std::string> Parse(std::vector<std::string> const& typed);

    CommonOptions const& GetCommon() const { return _common; }

    /// The verb that was parsed.
    Verb const& GetVerb() const;

    /// What the options of that verb are: an object, by their long names.
    nlohmann::json DescribeVerbsOptions() const;

    CLI::App const& GetApp() const { return _app; }

private:
    /// What is said of limn itself: a subcommand, and its text.
    struct Question {
        CLI::App* app;
        std::function<std::string()> answer;
    };

    void AddQuestions();
    void CheckBeginning(std::vector<std::string> const& arguments) const;
    void RequireVerb(std::string const& word) const;
    [[noreturn]] void Refuse(CLI::ParseError const& error) const;
    std::string MakeHelp(std::string const& verb) const;

    CLI::App _app{"limn bakes the true limit of subdivision surfaces.", "limn"};
    CommonOptions _common;
    std::vector<Verb> _verbs;
    std::vector<Question> _questions;
    OptionDefaults _defaults;
    std::string _helpVerb;  ///< that help was asked for
    Shell _shell = Shell::Bash;
};

}  // namespace limn::cli
