// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace limn::cli {

/// Words that an option takes among other values, so that its help cannot list all it takes: "p1"
/// of --preview-range, which takes A,B, too.
struct OfferedWords {
    std::vector<std::string> words{};
    bool isList = false;  ///< separated by commas
};

/// Those of an option; none of most.
OfferedWords FindOfferedWords(std::string_view longFlag);

}  // namespace limn::cli
