// SPDX-License-Identifier: Apache-2.0
#include "engine/bake/maps/preview_range.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "engine/io/unheld_number.h"
#include "far_ext/error.h"

namespace limn::engine {

namespace {

constexpr char const *kPercentiles = "p1", *kFull = "full", *kAsinh = "asinh";

std::optional<double> ParseNumber(std::string_view text) {
    double value = 0.0;
    char const *const begin = text.data(), *const end = begin + text.size();
    auto const [stop, code] = std::from_chars(begin, end, value);
    if (code == std::errc::result_out_of_range && stop == end) {
        throw Error(ErrorCode::BadOption,
                    fmt::format("`previewRange`: '{}' is {}", text, DescribeUnheld(text)));
    }
    if (code != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

}  // namespace

PreviewRange PreviewRange::Parse(std::string const& text) {
    if (text == kPercentiles) return {Rule::Percentiles};
    if (text == kFull) return {Rule::Full};
    if (text == kAsinh) return {Rule::Asinh};
    size_t const comma = text.find(',');
    if (comma != std::string::npos) {
        auto const low = ParseNumber(std::string_view(text).substr(0, comma)),
                   high = ParseNumber(std::string_view(text).substr(comma + 1));
        if (low && high && *low < *high) return {Rule::Given, *low, *high};
    }
    throw Error(ErrorCode::BadOption,
                fmt::format("`previewRange`: '{}' is not {}, {}, {} or two numbers A,B with A < B",
                            text, kPercentiles, kFull, kAsinh));
}

std::string PreviewRange::GetText() const {
    switch (rule) {
        case Rule::Percentiles:
            return kPercentiles;
        case Rule::Full:
            return kFull;
        case Rule::Asinh:
            return kAsinh;
        case Rule::Given:
            break;
    }
    return fmt::format("{},{}", low, high);
}

}  // namespace limn::engine
