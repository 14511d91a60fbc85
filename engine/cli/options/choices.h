// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace limn::cli {

/// The words that an option takes as its help shows them: "right|left".
std::string JoinChoices(std::vector<std::string> const& words);

/// The words again; none where the text is no list of choices.
std::vector<std::string> SplitChoices(std::string_view text);

/// \throws Error  BadOption: "--orientation: 'lft' is not one of right, left; did you mean left?"
[[noreturn]] void RefuseChoice(std::string_view option, std::string_view word,
                               std::vector<std::string> const& words);

}  // namespace limn::cli
