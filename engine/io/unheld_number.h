// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace limn::engine {

/// Of a decimal number that double cannot hold: whether it is too small rather than too large.
bool IsTooSmall(std::string_view number);

/// What is wrong with such a number, and what would be right: "too large a number; at most ...".
std::string DescribeUnheld(std::string_view number);

}  // namespace limn::engine
