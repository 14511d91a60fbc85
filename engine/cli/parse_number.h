// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::cli {

/// A finite number of an option's text, whatever the locale. \throws Error BadOption, naming the
/// option
inline double ParseNumber(std::string const& option, std::string_view text) {
    double value = 0.0;
    auto const [stop, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc() || stop != text.data() + text.size() || !std::isfinite(value)) {
        throw Error(ErrorCode::BadOption, fmt::format("{}: '{}' is not a number", option, text));
    }
    return value;
}

}  // namespace limn::cli
