// SPDX-License-Identifier: Apache-2.0
#include "far_ext/enum_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "far_ext/error.h"

namespace limn {

void ThrowUnknownWord(char const* member, std::string_view word,
                      std::vector<std::string> const& known) {
    throw Error(ErrorCode::BadOption,
                fmt::format("`{}`: '{}' is not one of {}", member, word, JoinWords(known)));
}

std::string JoinWords(std::vector<std::string> const& words) {
    return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace limn
