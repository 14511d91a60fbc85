// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/cli/options/option_list.h"
#include "engine/cli/terminal/completion.h"

namespace limn::cli {

namespace {

constexpr char const* kBashHead = R"(# shellcheck shell=bash
# Completes limn's command lines in bash. Made by `limn completion bash`.

_limn() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} done='' words=''
    local sign=''
    # Bash takes the = of --option=value for a word.
    if [[ $word == '=' ]]; then
        word='' sign='='
    elif [[ $before == '=' ]]; then
        before=${COMP_WORDS[COMP_CWORD - 2]} sign='='
    fi
    COMPREPLY=()
    case $COMP_CWORD:${COMP_WORDS[1]}:$before in
)";

constexpr char const* kBashTail = R"(    esac
    mapfile -t COMPREPLY < <(compgen -P "$done" -W "$words" -- "$word")
}

# Where this finds nothing bash completes file names.
complete -o bashdefault -o default -F _limn limn
)";

constexpr char const* kBashList = R"(        if [[ $word == *,* ]]; then
            done=${word%,*},
            word=${word##*,}
        fi
)";

/// "*:bake:-o | *:bake:--output", the flags of an option of a verb, as the script's cases have
/// them.
std::string JoinPatterns(std::string const& verb, OptionEntry const& option) {
    std::vector<std::string> patterns;
    for (std::string const& flag : ListFlags({option}))
        patterns.push_back(fmt::format("*:{}:{}", verb, flag));
    return fmt::format("{}", fmt::join(patterns, " | "));
}

/// What stands behind an option that takes a value: its words, else what bash finds. Without a '='
/// no flag has any, and the verb's own words follow.
std::string DescribeBashValue(std::string const& verb, OptionEntry const& option) {
    bool const isFlag = option.value == OptionEntry::Value::None;
    if (option.IsPositional() || (isFlag && !option.IsFlagWithWords())) return {};
    std::string const patterns = JoinPatterns(verb, option);
    if (option.words.empty()) return fmt::format("    {}) ;;\n", patterns);
    std::string text = fmt::format("    {})\n        {}words='{}'\n", patterns,
                                   isFlag ? "[[ ! $sign ]] || " : "", fmt::join(option.words, " "));
    if (option.isList) text += kBashList;
    return text + (isFlag ? "        ;;&\n" : "        ;;\n");
}

/// What a verb takes where nothing is awaited: its options, or the words of its positional.
std::string DescribeBashVerb(CLI::App const& verb) {
    auto const options = ListOptions(verb);
    std::string text = fmt::format("    *:{}:*)\n", verb.get_name());
    std::string positional;
    for (OptionEntry const& option : options) {
        if (option.IsPositional()) positional = fmt::format("{}", fmt::join(option.words, " "));
    }
    text += fmt::format("        if [[ $word == -* ]]; then words='{}'; ",
                        fmt::join(ListFlags(options), " "));
    text += positional.empty() ? "fi\n" : fmt::format("else words='{}'; fi\n", positional);
    return text + "        ;;\n";
}

}  // namespace

std::string WriteBashCompletion(CLI::App const& app) {
    auto const verbs = ListVerbs(app);
    std::string names, text = kBashHead;
    for (CLI::App const* const verb : verbs) names += verb->get_name() + " ";
    text += fmt::format("    1:*) words='{}{}' ;;\n", names,
                        fmt::join(ListFlags(ListOptions(app)), " "));
    for (OptionEntry const& option : ListCommonOptions(app)) text += DescribeBashValue("*", option);
    for (CLI::App const* const verb : verbs) {
        for (OptionEntry const& option : ListOptions(*verb)) {
            if (!option.IsCommon()) text += DescribeBashValue(verb->get_name(), option);
        }
        text += DescribeBashVerb(*verb);
    }
    return text + kBashTail;
}

}  // namespace limn::cli
