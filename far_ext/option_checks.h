// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <ranges>
#include <string>
#include <type_traits>

#include <fmt/format.h>

#include "far_ext/enum_words.h"
#include "far_ext/error.h"

namespace limn {

// What the checks of options are made of. All throw BadOption, and name the option's member, its
// value and what is possible.

/// The largest number that inputs may hold, as of coordinates in files: what is made of it stays
/// within the range of float and double.
inline constexpr double kLargestInput = 1e30;

[[noreturn]] inline void RefuseOption(char const* member, std::string const& why) {
    throw Error(ErrorCode::BadOption, fmt::format("`{}`: {}", member, why));
}

/// Refuses NaN, too.
template <class Number>
void RequireRange(char const* member, Number value, std::type_identity_t<Number> low,
                  std::type_identity_t<Number> high) {
    if (value >= low && value <= high) return;
    RefuseOption(member, fmt::format("{} is not from {} to {}", value, low, high));
}

inline void RequireAtLeast(char const* member, int value, int low) {
    if (value < low) RefuseOption(member, fmt::format("{} is not {} or more", value, low));
}

inline void RequireAboveZero(char const* member, double value) {
    if (value > 0.0 && std::isfinite(value)) return;
    RefuseOption(member, fmt::format("{} is no finite number above 0", value));
}

/// \param what  the number is, where the member has several: "the weight "
inline void RequireFinite(char const* member, double value, std::string const& what = {}) {
    if (!std::isfinite(value))
        RefuseOption(member, fmt::format("{}{} is no finite number", what, value));
}

template <std::ranges::range Numbers>
void RequireAllFinite(char const* member, Numbers const& values) {
    size_t index = 0;
    for (double const value : values)
        RequireFinite(member, value, fmt::format("number {}: ", index++));
}

/// Of what becomes texels: not beyond kLargestInput either.
inline void RequireModest(char const* member, double value, std::string const& what = {}) {
    if (std::abs(value) <= kLargestInput) return;
    RefuseOption(member, fmt::format("{}{} is no number from -{:g} to {:g}", what, value,
                                     kLargestInput, kLargestInput));
}

/// Refuses a value that has no word.
template <class Value, size_t N>
void RequireKnown(EnumWords<Value, N> const& words, std::type_identity_t<Value> value) {
    for (auto const& row : words.rows) {
        if (row.value == value) return;
    }
    ThrowUnknownWord(words.member, std::to_string(static_cast<int>(value)), words.List());
}

/// The same of an enumeration without words, whose enumerators are numbered to `last`.
template <class Value>
void RequireEnumerator(char const* member, Value value, std::type_identity_t<Value> last) {
    RequireRange(member, static_cast<int>(value), 0, static_cast<int>(last));
}

}  // namespace limn
