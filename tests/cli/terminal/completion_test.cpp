// SPDX-License-Identifier: Apache-2.0
//
// Completion, manual page and help are made from the options; none may miss one.

#include <algorithm>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include "engine/cli/parser.h"
#include "engine/cli/terminal/manual.h"
#include "support/program/cli.h"

namespace limn {
namespace {

using namespace test::cli;
using cli::Parser;

bool IsInstalled(std::string const& program) {
    return test::Process({"/bin/sh", "-c", "command -v " + program}).Wait().status == 0;
}

/// The verbs as CLI11 knows them.
std::vector<CLI::App const*> VerbsOf(Parser const& parser) {
    return parser.GetApp().get_subcommands([](CLI::App const*) { return true; });
}

/// "-o", "--output", ... of a verb.
Words FlagsOf(CLI::App const& verb) {
    Words flags;
    for (CLI::Option const* option : verb.get_options()) {
        for (std::string const& name : option->get_snames()) flags.push_back("-" + name);
        for (std::string const& name : option->get_lnames()) flags.push_back("--" + name);
    }
    return flags;
}

/// The part of a text from one mark to the next.
std::string Between(std::string const& text, std::string const& start, std::string const& end) {
    size_t const from = text.find(start);
    if (from == std::string::npos) return {};
    return text.substr(from, text.find(end, from + start.size()) - from);
}

/// What bash offers for each of these command lines, whose last word is being typed.
std::vector<Words> CompleteAllInBash(std::vector<Words> const& commandLines) {
    test::TemporaryFolder const folder;
    std::string script = Limn({"completion", "bash"}).out;
    for (Words const& words : commandLines) {
        script += "COMP_WORDS=(";
        for (std::string const& word : words) script += "'" + word + "' ";
        script += ")\nCOMP_CWORD=" + std::to_string(words.size() - 1) +
                  "\n_limn\necho \"${COMPREPLY[*]}\"\n";
    }
    Outcome const outcome =
        test::Process({"/bin/bash", folder.Write("complete.sh", script)}).Wait();
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    std::vector<Words> answers;
    for (std::string const& line : Lines(outcome.out)) {
        std::istringstream stream(line);
        answers.emplace_back(std::istream_iterator<std::string>(stream),
                             std::istream_iterator<std::string>());
    }
    EXPECT_EQ(answers.size(), commandLines.size());
    answers.resize(commandLines.size());
    return answers;
}

Words CompleteInBash(Words const& commandLine) {
    return CompleteAllInBash({commandLine})[0];
}

/// Asks of every flag of every verb whether `knows(verb, flag)`.
void ExpectAllFlags(std::function<bool(CLI::App const&, std::string const&)> const& knows) {
    Parser const parser;
    size_t count = 0;
    for (CLI::App const* verb : VerbsOf(parser)) {
        for (std::string const& flag : FlagsOf(*verb)) {
            EXPECT_TRUE(knows(*verb, flag)) << verb->get_name() << " " << flag;
            ++count;
        }
    }
    EXPECT_GT(count, 200u);
}

TEST(Completion, HelpKnowsEveryOptionOfEveryVerb) {
    ExpectAllFlags([](CLI::App const& verb, std::string const& flag) {
        std::string const help = verb.help("limn");
        return Contains(help, "  " + flag) || Contains(help, "," + flag);
    });
}

TEST(Completion, ManualKnowsEveryOptionOfEveryVerb) {
    Parser const parser;
    std::string const manual = cli::WriteManual(parser.GetApp()) + ".SH";
    std::string const common = Between(manual, ".SS Options every verb shares\n", ".SH");
    ExpectAllFlags([&](CLI::App const& verb, std::string const& flag) {
        std::string const section = Between(manual, ".SS limn " + verb.get_name() + "\n", ".S");
        std::string escaped;
        for (char c : flag) escaped += c == '-' ? "\\-" : std::string(1, c);
        std::string const alone = "\\fB" + escaped + "\\fR", second = ", " + escaped + "\\fR",
                          first = "\\fB" + escaped + ", ";
        auto const has = [&](std::string const& text) {
            return Contains(text, alone) || Contains(text, first) || Contains(text, second);
        };
        return has(section) || has(common);
    });
}

TEST(Completion, BashKnowsEveryVerbAndEveryOptionOfIt) {
    Parser const parser;
    auto const verbs = VerbsOf(parser);
    std::vector<Words> commandLines{{"limn", ""}};
    for (CLI::App const* verb : verbs) commandLines.push_back({"limn", verb->get_name(), "-"});
    auto const answers = CompleteAllInBash(commandLines);
    for (size_t i = 0; i < verbs.size(); ++i) {
        EXPECT_EQ(std::ranges::count(answers[0], verbs[i]->get_name()), 1);
        EXPECT_EQ(answers[i + 1], FlagsOf(*verbs[i])) << verbs[i]->get_name();
    }
}

TEST(Completion, ZshKnowsEveryOptionOfEveryVerb) {
    std::string const script = Limn({"completion", "zsh"}).out;
    std::string const common = Between(script, "common=(", "\n    )");
    ExpectAllFlags([&](CLI::App const& verb, std::string const& flag) {
        std::string const block = Between(script, "\n        " + verb.get_name() + ")", ";;");
        auto const has = [&](std::string const& text) {
            return Contains(text, "'*" + flag + "[") || Contains(text, "'*" + flag + "=[") ||
                   Contains(text, "'*" + flag + "=-[");
        };
        return has(block) || (Contains(block, "$common") && has(common));
    });
}

TEST(Completion, FishKnowsEveryOptionOfEveryVerb) {
    auto const lines = Lines(Limn({"completion", "fish"}).out);
    ExpectAllFlags([&](CLI::App const& verb, std::string const& flag) {
        std::string const option =
            flag.starts_with("--") ? " -l " + flag.substr(2) + " " : " -s " + flag.substr(1) + " ";
        return std::ranges::any_of(lines, [&](std::string const& line) {
            std::string const condition = Between(line, "__fish_seen_subcommand_from", "'") + " ";
            return Contains(condition, " " + verb.get_name() + " ") && Contains(line, option);
        });
    });
}

TEST(Completion, BashOffersTheWordsOfAnOption) {
    EXPECT_EQ(CompleteInBash({"limn", "info", "a.obj", "--scheme", ""}),
              (Words{"catmark", "loop", "bilinear"}));
    EXPECT_EQ(CompleteInBash({"limn", "fit", "--method", "c"}), (Words{"chebyshev", "cg"}));
    EXPECT_EQ(CompleteInBash({"limn", "bake", "--compression", "=", "zi"}), (Words{"zip", "zips"}));
    EXPECT_EQ(CompleteInBash({"limn", "bake", "--compression", "="}).size(), 6u);
    EXPECT_EQ(CompleteInBash({"limn", "completion", ""}), (Words{"bash", "zsh", "fish"}));
    EXPECT_EQ(CompleteInBash({"limn", "help", "den"}), Words{"denoise"});
    EXPECT_EQ(CompleteInBash({"limn", "me"}), Words{"measure"});
}

TEST(Completion, BashOffersMapsAfterACommaToo) {
    EXPECT_EQ(CompleteInBash({"limn", "bake", "--maps", "me"}), Words{"mean"});
    EXPECT_EQ(CompleteInBash({"limn", "bake", "--maps", "mean,no"}),
              (Words{"mean,normal", "mean,noise"}));
}

TEST(Completion, BashOffersWordsThatStandAmongOtherValues) {
    Words const ranges{"p1", "full", "asinh"};
    EXPECT_EQ(CompleteInBash({"limn", "bake", "--preview-range", ""}), ranges);
    EXPECT_EQ(CompleteInBash({"limn", "measure", "--preview-range", "=", ""}), ranges);
    EXPECT_EQ(CompleteInBash({"limn", "bake", "--origin", ""}), Words{"auto"});
}

TEST(Completion, BashOffersTheWordsOfAFlagBehindItsSignOnly) {
    EXPECT_EQ(CompleteInBash({"limn", "bake", "--half", "=", "me"}), Words{"mean"});
    EXPECT_EQ(CompleteInBash({"limn", "bake", "--half", "=", "mean,no"}),
              (Words{"mean,normal", "mean,noise"}));
    EXPECT_EQ(CompleteInBash({"limn", "measure", "--picture", "="}), (Words{"mean", "gaussian"}));
    EXPECT_EQ(CompleteInBash({"limn", "bake", "--half", ""}), Words{});
    EXPECT_EQ(CompleteInBash({"limn", "bake", "--half", "--previ"}),
              (Words{"--preview", "--preview-legend", "--preview-range"}));
}

TEST(Completion, BashLeavesFilesAndNumbersToItself) {
    EXPECT_EQ(CompleteInBash({"limn", "info", ""}), Words{});
    EXPECT_EQ(CompleteInBash({"limn", "bake", "-o", ""}), Words{});
    EXPECT_EQ(CompleteInBash({"limn", "bake", "--samples", ""}), Words{});
    EXPECT_EQ(CompleteInBash({"limn", "bake", "--against", ""}), Words{});
}

TEST(Completion, BashScriptPassesShellcheck) {
    if (!IsInstalled("shellcheck")) GTEST_SKIP() << "no shellcheck";
    test::TemporaryFolder const folder;
    std::string const script = folder.Write("limn.bash", Limn({"completion", "bash"}).out);
    EXPECT_EQ(test::Process({"/bin/sh", "-c", "shellcheck " + script}).Wait().out, "");
}

TEST(Completion, ShellsReadTheirScripts) {
    test::TemporaryFolder const folder;
    int count = 0;
    for (std::string const shell : {"bash", "zsh", "fish"}) {
        if (!IsInstalled(shell)) continue;
        ++count;
        std::string const script = folder.Write("limn." + shell, Limn({"completion", shell}).out);
        Outcome const outcome = test::Process({"/bin/sh", "-c", shell + " -n " + script}).Wait();
        EXPECT_EQ(outcome.status, 0) << shell << ": " << outcome.err;
    }
    EXPECT_GE(count, 1);
}

TEST(Completion, ManualIsSoundRoff) {
    if (!IsInstalled("man") || !IsInstalled("groff")) GTEST_SKIP() << "no man or groff";
    test::TemporaryFolder const folder;
    std::string const page = folder.Write("limn.1", Limn({"manual"}).out);
    Outcome const outcome =
        test::Process({"/bin/sh", "-c", "LC_ALL=C.UTF-8 MANWIDTH=100 man --warnings -l " + page})
            .Wait();
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    EXPECT_TRUE(
        Contains(outcome.out, "limn bake scenes/spot/spot.obj -o 'out/spot.{map}.<UDIM>.exr'"))
        << outcome.out;
}

}  // namespace
}  // namespace limn
