// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/cli/options/option_list.h"
#include "engine/cli/terminal/completion.h"

namespace limn::cli {

namespace {

std::string QuoteForFish(std::string_view text) {
    std::string quoted = "'";
    for (char c : text) {
        if (c == '\'' || c == '\\') quoted += '\\';
        quoted += c;
    }
    return quoted + "'";
}

/// What fish offers behind an option: words, nothing, or files. Behind a flag that is one with '='
/// only, without -x and -r.
std::string DescribeFishValue(OptionEntry const& option) {
    using Value = OptionEntry::Value;
    std::string words = fmt::format("{}", fmt::join(option.words, " "));
    if (option.isList) words = "(__fish_append , " + words + ")";
    switch (option.value) {
        case Value::None:
            return option.IsFlagWithWords() ? " -f -a " + QuoteForFish(words) : "";
        case Value::Number:
            return " -x";
        case Value::Words:
            return " -x -a " + QuoteForFish(words);
        case Value::Other:
            return " -r";
    }
    return {};
}

/// \param condition  where the option may stand
std::string DescribeFishOption(std::string const& condition, OptionEntry const& option) {
    std::string text = "complete -c limn -n " + QuoteForFish(condition);
    if (option.IsPositional()) {
        if (option.words.empty()) return {};  // files, as everywhere
        return text + fmt::format(" -f -a {}\n",
                                  QuoteForFish(fmt::format("{}", fmt::join(option.words, " "))));
    }
    if (!option.shortFlag.empty()) text += " -s " + option.shortFlag.substr(1);
    if (!option.longFlag.empty()) text += " -l " + option.longFlag.substr(2);
    return text + DescribeFishValue(option) + " -d " + QuoteForFish(option.help) + "\n";
}

}  // namespace

std::string WriteFishCompletion(CLI::App const& app) {
    std::string text =
        "# Completes limn's command lines in fish. Made by `limn completion fish`.\n\n";
    for (OptionEntry const& option : ListOptions(app))
        text += DescribeFishOption("__fish_use_subcommand", option);
    std::string takers = "__fish_seen_subcommand_from";
    for (CLI::App const* const verb : ListVerbs(app)) {
        text += fmt::format("complete -c limn -n __fish_use_subcommand -f -a {} -d {}\n",
                            verb->get_name(), QuoteForFish(verb->get_description()));
        bool hasCommon = false;
        for (OptionEntry const& option : ListOptions(*verb)) {
            hasCommon |= option.IsCommon();
            if (!option.IsCommon())
                text +=
                    DescribeFishOption("__fish_seen_subcommand_from " + verb->get_name(), option);
        }
        if (hasCommon) takers += " " + verb->get_name();
    }
    for (OptionEntry const& option : ListCommonOptions(app))
        text += DescribeFishOption(takers, option);
    return text;
}

}  // namespace limn::cli
