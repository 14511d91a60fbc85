// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "engine/cli/options/choices.h"
#include "far_ext/enum_words.h"

namespace limn::cli {

/// An option that takes one of the words, which its help lists.
///
/// \param target  a Value or an optional of one; outlives the verb
template <class Target, class Value, size_t N>
CLI::Option* AddWordOption(CLI::App& verb, std::string const& flag, Target& target,
                           EnumWords<Value, N> const& words, std::string const& help) {
    auto const parse = [&target, &words, flag](std::string const& word) {
        auto const value = words.Find(word);
        if (!value) RefuseChoice(flag, word, words.List());
        target = Value{*value};
    };
    auto* const option = verb.add_option_function<std::string>(flag, parse, help);
    for (auto const& row : words.rows) {
        if (target == row.value) option->default_str(row.word);
    }
    return option->type_name(JoinChoices(words.List()));
}

}  // namespace limn::cli
