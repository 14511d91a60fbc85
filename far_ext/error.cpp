// SPDX-License-Identifier: Apache-2.0
#include "far_ext/error.h"

#include <algorithm>

namespace limn {

std::string MakeOneLine(std::string text) {
    std::ranges::replace_if(text, [](char c) { return c == '\n' || c == '\r' || c == '\0'; }, ' ');
    return text;
}

}  // namespace limn
