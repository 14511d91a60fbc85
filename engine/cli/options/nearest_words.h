// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace limn::cli {

/// The known words that somebody may have meant by a word that is none of them: of those that it
/// begins, or that are a few edits away (a letter more, less, another one, or two neighbours
/// swapped; capitals count for nothing), the nearest. Several only where they are equally near.
std::vector<std::string> FindNearestWords(std::string_view word,
                                          std::vector<std::string> const& known);

/// "; did you mean --size?", or nothing where no word is near.
std::string AskForNearest(std::string_view word, std::vector<std::string> const& known);

}  // namespace limn::cli
