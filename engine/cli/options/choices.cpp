// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/options/choices.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/cli/options/nearest_words.h"
#include "far_ext/error.h"

namespace limn::cli {

std::string JoinChoices(std::vector<std::string> const& words) {
    return fmt::format("{}", fmt::join(words, "|"));
}

std::vector<std::string> SplitChoices(std::string_view text) {
    std::vector<std::string> words;
    if (text.find('|') == text.npos) return words;
    for (size_t start = 0; start <= text.size();) {
        size_t const end = std::min(text.find('|', start), text.size());
        words.emplace_back(text.substr(start, end - start));
        start = end + 1;
    }
    return words;
}

void RefuseChoice(std::string_view option, std::string_view word,
                  std::vector<std::string> const& words) {
    throw Error(ErrorCode::BadOption,
                fmt::format("{}: '{}' is not one of {}{}", option, word, fmt::join(words, ", "),
                            AskForNearest(word, words)));
}

}  // namespace limn::cli
