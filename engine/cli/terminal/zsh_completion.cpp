// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/cli/options/option_list.h"
#include "engine/cli/terminal/completion.h"

namespace limn::cli {

namespace {

constexpr char const* kZshHead = R"(#compdef limn
# Completes limn's command lines in zsh. Made by `limn completion zsh`.

_limn() {
    local context state state_descr line
    typeset -A opt_args
    local -a verbs common
)";

constexpr char const* kZshTail = R"(        esac
        ;;
    esac
}

# Found by its name in a folder of $fpath, or read by `source`.
if [[ $funcstack[1] == _limn ]]; then
    _limn "$@"
else
    compdef _limn limn
fi
)";

/// As a word of the shell.
std::string QuoteForZsh(std::string_view text) {
    std::string quoted = "'";
    for (char c : text) quoted += c == '\'' ? "'\\''" : std::string(1, c);
    return quoted + "'";
}

/// "[how often]": an explanation as _arguments reads it.
std::string Explain(std::string_view help) {
    std::string text = "[";
    for (char c : help) {
        if (c == '[' || c == ']' || c == '\\') text += '\\';
        text += c;
    }
    return text + "]";
}

/// ":size: ": the name of a value and what completes it. A space before an action keeps what
/// _arguments knows of the value to itself; alone it completes nothing.
std::string DescribeZshValue(std::string_view name, OptionEntry const& option) {
    using Value = OptionEntry::Value;
    std::string const words = fmt::format("{}", fmt::join(option.words, " "));
    switch (option.value) {
        case Value::None:
            if (!option.IsFlagWithWords()) return {};
            [[fallthrough]];
        case Value::Words:
            return option.isList ? fmt::format(":{}: _values -s , {} {}", name, name, words)
                                 : fmt::format(":{}:({})", name, words);
        case Value::Number:
            return fmt::format(":{}: ", name);
        case Value::Other:
            return fmt::format(":{}:_files", name);
    }
    return {};
}

/// Specs of _arguments, e.g. '*--size=[texels: N or WxH]:size:_files', one for each flag.
std::string DescribeZshOption(OptionEntry const& option) {
    bool const takesValue = option.value != OptionEntry::Value::None;
    // "=-[...]:": a value stands behind the sign at once; "::" in its place: or there is none.
    char const* const longSign = takesValue ? "=" : option.IsFlagWithWords() ? "=-" : "";
    std::vector<std::string> specs;
    for (std::string const& flag : ListFlags({option})) {
        specs.push_back(QuoteForZsh("*" + flag + (flag.starts_with("--") ? longSign : "") +
                                    Explain(option.help) + (option.IsFlagWithWords() ? ":" : "") +
                                    DescribeZshValue(option.longFlag.substr(2), option)));
    }
    return fmt::format("{}", fmt::join(specs, " "));
}

std::string DescribeZshVerb(CLI::App const& verb) {
    std::vector<std::string> specs;
    std::string rest = "'*:file:_files'";
    bool hasCommon = false;
    for (OptionEntry const& option : ListOptions(verb)) {
        hasCommon |= option.IsCommon();
        if (option.IsPositional() && !option.words.empty())
            rest = QuoteForZsh("1" + DescribeZshValue(option.placeholder, option));
        else if (!option.IsPositional() && !option.IsCommon())
            specs.push_back(DescribeZshOption(option));
    }
    if (hasCommon) specs.push_back("$common");
    specs.push_back(rest);
    return fmt::format(
        "        {})\n            _arguments -s \\\n                {}\n            ;;\n",
        verb.get_name(), fmt::join(specs, " \\\n                "));
}

}  // namespace

std::string WriteZshCompletion(CLI::App const& app) {
    std::string text = kZshHead;
    text += "    verbs=(\n";
    for (CLI::App const* const verb : ListVerbs(app))
        text += fmt::format("        {}\n",
                            QuoteForZsh(verb->get_name() + ":" + verb->get_description()));
    text += "    )\n    common=(\n";
    for (OptionEntry const& option : ListCommonOptions(app))
        text += fmt::format("        {}\n", DescribeZshOption(option));
    text += "    )\n    _arguments -C";
    for (OptionEntry const& option : ListOptions(app))
        text += fmt::format(" \\\n        {}", DescribeZshOption(option));
    text +=
        " \\\n        '1:verb:->verb' '*::argument:->argument'\n"
        "    case $state in\n"
        "    verb) _describe -t commands verb verbs ;;\n"
        "    argument)\n"
        "        case $line[1] in\n";
    for (CLI::App const* const verb : ListVerbs(app)) text += DescribeZshVerb(*verb);
    return text + kZshTail;
}

}  // namespace limn::cli
