// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/cli/options/number.h"

namespace limn::cli {

/// What a target of numbers holds: int of an int, of an optional or of a vector of them.
template <class Target>
struct NumberOf {
    using Type = Target;
};
template <class Number>
struct NumberOf<std::optional<Number>> {
    using Type = Number;
};
template <class Number>
struct NumberOf<std::vector<Number>> {
    using Type = Number;
    static constexpr bool kIsList = true;
};

/// What an option is where nobody gives it: "2", "[1,0.6,0.8]", nothing where limn chooses.
template <class Target>
std::string FormatDefault(Target const& target) {
    if constexpr (requires { NumberOf<Target>::kIsList; })
        return fmt::format("[{}]", fmt::join(target, ","));
    else if constexpr (requires { target.has_value(); })
        return target ? fmt::format("{}", *target) : "";
    else
        return fmt::format("{}", target);
}

/// An option that takes numbers, by ParseNumber.
///
/// \param target  int, uint64_t or double, or an optional or a vector of them; outlives the verb
template <class Target, class Number = typename NumberOf<Target>::Type>
CLI::Option* AddNumberOption(CLI::App& verb, std::string const& flag, Target& target,
                             std::string const& help,
                             std::type_identity_t<NumberRange<Number>> const& range = {}) {
    auto const parse = [&target, flag, range](CLI::results_t const& texts) {
        if constexpr (requires { NumberOf<Target>::kIsList; }) {
            target.clear();
            for (std::string const& text : texts) target.push_back(ParseNumber(flag, text, range));
        } else {
            target = ParseNumber(flag, texts[0], range);
        }
        return true;
    };
    auto* const option =
        verb.add_option(flag, parse, help, false, [&target] { return FormatDefault(target); });
    if constexpr (requires { NumberOf<Target>::kIsList; })
        option->expected(CLI::detail::expected_max_vector_size);  // one or more
    return option->type_name(MakePlaceholder(range));
}

}  // namespace limn::cli
