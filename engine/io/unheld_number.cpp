// SPDX-License-Identifier: Apache-2.0
#include "engine/io/unheld_number.h"

#include <algorithm>
#include <charconv>
#include <limits>

#include <fmt/format.h>

namespace limn::engine {

bool IsTooSmall(std::string_view number) {
    size_t const end = std::min(number.find_first_of("eE"), number.size());
    std::string_view const digits = number.substr(0, end);
    std::string_view exponentText = number.substr(std::min(end + 1, number.size()));
    if (exponentText.starts_with('+')) exponentText.remove_prefix(1);
    long long exponent = 0;
    auto const code =
        std::from_chars(exponentText.data(), exponentText.data() + exponentText.size(), exponent)
            .ec;
    if (code == std::errc::result_out_of_range) return exponentText.starts_with('-');
    auto const point = static_cast<long long>(std::min(digits.find('.'), digits.size()));
    auto const first =
        static_cast<long long>(std::min(digits.find_first_of("123456789"), digits.size()));
    // 123.4 is 1.234e2, 0.001234 is 1.234e-3
    long long const power = first < point ? point - first - 1 : point - first;
    return power < -exponent;
}

std::string DescribeUnheld(std::string_view number) {
    using Limits = std::numeric_limits<double>;
    if (IsTooSmall(number)) {
        return fmt::format("too small a number; 0, or at least {:g} in magnitude, is possible",
                           Limits::denorm_min());
    }
    return fmt::format("too large a number; at most {:g} in magnitude is possible", Limits::max());
}

}  // namespace limn::engine
