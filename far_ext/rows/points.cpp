// SPDX-License-Identifier: Apache-2.0
#include "far_ext/rows/points.h"

#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::far_ext {

void CheckLength(std::string_view name, std::span<double const> values, Index count,
                 std::string_view owners, int length) {
    if (values.size() >= static_cast<size_t>(count) * length) return;
    throw Error(ErrorCode::BadOption, fmt::format("{}: {} values are too few for {} {} of {}", name,
                                                  values.size(), count, owners, length));
}

}  // namespace limn::far_ext
