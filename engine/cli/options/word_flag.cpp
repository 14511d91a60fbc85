// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/options/word_flag.h"

#include <algorithm>

#include "engine/cli/options/choices.h"

namespace limn::cli {

namespace {

/// The words that may follow a flag; none for all that is no such flag.
std::vector<std::string> ListWordsAfter(CLI::App const& verb, std::string const& word) {
    if (!word.starts_with("--")) return {};
    auto const* const option = verb.get_option_no_throw(word);
    bool const isFlag = option && option->get_items_expected_max() == 0;
    return isFlag ? SplitChoices(option->get_type_name()) : std::vector<std::string>();
}

}  // namespace

CLI::Option* AddWordFlag(CLI::App& verb, std::string const& flag, std::string& target,
                         std::vector<std::string> const& words, std::string const& help) {
    return verb.add_flag(flag, target, help)->type_name(JoinChoices(words));
}

std::vector<std::string> JoinWordFlags(CLI::App const& verb, std::vector<std::string> words) {
    for (size_t i = 0; i + 1 < words.size() && words[i] != "--"; ++i) {
        auto const choices = ListWordsAfter(verb, words[i]);
        if (std::ranges::find(choices, words[i + 1]) == choices.end()) continue;
        words[i] += "=" + words[i + 1];
        words.erase(words.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    }
    return words;
}

}  // namespace limn::cli
