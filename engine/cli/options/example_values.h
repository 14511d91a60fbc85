// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "engine/cli/options/option_list.h"

namespace limn::cli {

/// A value that an option may have, as it is typed: "2048" of --size. What its default says, unless
/// that is none or says little; the first of its words.
///
/// \param byDefault  as CLI11 shows it: "2", "[1,0.6,0.8]"; may be empty
std::string FindExample(OptionEntry const& option, std::string_view verb,
                        std::string const& byDefault);

}  // namespace limn::cli
