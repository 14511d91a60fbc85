// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace limn::engine {

/// What a person would want to know of the temporaries that killed runs have left in the folders of
/// some outputs, more than a day ago: one line, empty where there are none.
///
/// \param written  files just written: they say what time it is on their folder's clock
std::string DescribeLeftTemporaries(std::vector<std::string> const& written);

}  // namespace limn::engine
