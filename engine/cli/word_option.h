// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "far_ext/enum_words.h"

namespace limn::cli {

/// An option that takes one of the words, which its help lists.
///
/// \param target  a Value or an optional of one; outlives the verb
template <class Target, class Value, size_t N>
CLI::Option* AddWordOption(CLI::App& verb, std::string const& flag, Target& target,
                           EnumWords<Value, N> const& words, std::string const& help) {
    auto* const option = verb.add_option_function<std::string>(
        flag, [&target, &words](std::string const& word) { target = words.Parse(word); }, help);
    for (auto const& row : words.rows) {
        if (target == row.value) option->default_str(row.word);
    }
    return option->check(CLI::IsMember(words.List()));
}

}  // namespace limn::cli
