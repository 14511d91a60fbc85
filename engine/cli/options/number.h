// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace limn::cli {

// The one door for numbers of the command line: finite, whatever the locale, whole where an integer
// is meant. What is refused is quoted with its option and with what would be right.

template <class Number>
struct NumberRange {
    Number low = std::numeric_limits<Number>::lowest();
    Number high = std::numeric_limits<Number>::max();
};

/// What stands for the number in help: "INT from 0 to 10", "FLOAT from 0 up", "FLOAT".
template <class Number>
std::string MakePlaceholder(NumberRange<Number> const& range);

/// The number of the range that is all of the text, or nothing.
///
/// \param Number  int, uint64_t or double
template <class Number>
std::optional<Number> FindNumber(std::string_view text, NumberRange<Number> const& range = {});

/// The same.
///
/// \throws Error  BadOption: "--levels: 'abc' is no whole number from 0 to 10"
template <class Number>
Number ParseNumber(std::string_view option, std::string_view text,
                   NumberRange<Number> const& range = {});

/// A width and a height.
struct TexelSize {
    int width, height;
};

/// "2048" or "4096x2048"; 2k or 2K is 2048.
///
/// \throws Error  BadOption, as ParseNumber
TexelSize ParseTexelSize(std::string_view option, std::string_view text,
                         NumberRange<int> const& range);

}  // namespace limn::cli
