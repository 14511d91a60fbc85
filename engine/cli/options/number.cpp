// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/options/number.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <optional>

#include <fmt/format.h>

#include "engine/io/unheld_number.h"
#include "far_ext/error.h"

namespace limn::cli {

namespace {

/// The number that is all of a text.
template <class Number>
struct ReadNumber {
    Number value{};
    std::errc code{};  ///< result_out_of_range: it is a number, which the type cannot hold
};

template <class Number>
ReadNumber<Number> Read(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    ReadNumber<Number> read;
    char const *const begin = text.data(), *const end = begin + text.size();
    auto const [stop, code] = std::from_chars(begin, end, read.value);
    read.code = stop == end ? code : std::errc::invalid_argument;
    return read;
}

/// As short as it can be said: 1e+12, not 1000000000000.0.
template <class Number>
std::string Format(Number value) {
    if constexpr (std::integral<Number>) return fmt::format("{}", value);
    return fmt::format("{:g}", static_cast<double>(value));
}

/// " from 0 to 10", " from 0 up", or nothing.
template <class Number>
std::string DescribeBounds(NumberRange<Number> const& range) {
    NumberRange<Number> const any;
    if (range.high < any.high)
        return fmt::format(" from {} to {}", Format(range.low), Format(range.high));
    bool const hasLow = range.low > any.low || std::unsigned_integral<Number>;
    return hasLow ? fmt::format(" from {} up", Format(range.low)) : "";
}

template <class Number>
std::string_view GetKind() {
    return std::integral<Number> ? "whole number" : "number";
}

/// What is wrong with a text that is no number of the range.
template <class Number>
std::string DescribeNumberFault(std::string_view text, NumberRange<Number> const& range) {
    if (Read<Number>(text).code == std::errc::result_out_of_range) {
        // The range says what is wrong where it ends before the type does.
        NumberRange<Number> const any;
        bool const isOpen = text.starts_with('-') ? range.low == any.low : range.high == any.high;
        if constexpr (std::integral<Number>) {
            if (isOpen) {
                return fmt::format("too large a number; at most {} in magnitude is possible",
                                   any.high);
            }
        } else {
            bool const isAllowed =
                engine::IsTooSmall(text) ? range.low <= 0.0 && range.high >= 0.0 : isOpen;
            if (isAllowed) return engine::DescribeUnheld(text);
        }
    }
    return fmt::format("no {}{}", GetKind<Number>(), DescribeBounds(range));
}

/// "2048", "2k" or "2K".
std::optional<int> FindTexels(std::string_view text, NumberRange<int> const& range) {
    bool const isKilo = text.ends_with('k') || text.ends_with('K');
    if (!isKilo) return FindNumber(text, range);
    text.remove_suffix(1);
    auto const count = FindNumber<int>(text, {1, range.high / 1024});
    return count && *count * 1024 >= range.low ? std::optional(*count * 1024) : std::nullopt;
}

}  // namespace

template <class Number>
std::optional<Number> FindNumber(std::string_view text, NumberRange<Number> const& range) {
    auto const [value, code] = Read<Number>(text);
    if (code != std::errc()) return std::nullopt;
    if (!(value >= range.low && value <= range.high)) return std::nullopt;  // nor is NaN
    return value;
}

template <class Number>
std::string MakePlaceholder(NumberRange<Number> const& range) {
    return (std::integral<Number> ? "INT" : "FLOAT") + DescribeBounds(range);
}

template <class Number>
Number ParseNumber(std::string_view option, std::string_view text,
                   NumberRange<Number> const& range) {
    if (auto const value = FindNumber(text, range)) return *value;
    throw Error(ErrorCode::BadOption,
                fmt::format("{}: '{}' is {}", option, text, DescribeNumberFault(text, range)));
}

template std::string MakePlaceholder(NumberRange<int> const&);
template std::string MakePlaceholder(NumberRange<uint64_t> const&);
template std::string MakePlaceholder(NumberRange<double> const&);
template std::optional<int> FindNumber(std::string_view, NumberRange<int> const&);
template std::optional<uint64_t> FindNumber(std::string_view, NumberRange<uint64_t> const&);
template std::optional<double> FindNumber(std::string_view, NumberRange<double> const&);
template int ParseNumber(std::string_view, std::string_view, NumberRange<int> const&);
template uint64_t ParseNumber(std::string_view, std::string_view, NumberRange<uint64_t> const&);
template double ParseNumber(std::string_view, std::string_view, NumberRange<double> const&);

TexelSize ParseTexelSize(std::string_view option, std::string_view text,
                         NumberRange<int> const& range) {
    size_t const cross = std::min(text.find_first_of("xX"), text.size());
    auto const width = FindTexels(text.substr(0, cross), range);
    auto const height = cross < text.size() ? FindTexels(text.substr(cross + 1), range) : width;
    if (width && height) return {*width, *height};
    throw Error(ErrorCode::BadOption,
                fmt::format("{}: '{}' is no number of texels from {} to {}, such as 2048 or 2k, "
                            "and no two of them, such as 4kx2k",
                            option, text, range.low, range.high));
}

}  // namespace limn::cli
