// SPDX-License-Identifier: Apache-2.0
#include "engine/cli/option_rules.h"

#include <fmt/format.h>

#include "far_ext/error.h"

namespace limn::cli {

void RefuseTogether(CLI::App const& verb, std::vector<char const*> const& flags) {
    char const* first = nullptr;
    for (char const* flag : flags) {
        if (verb.count(flag) == 0) continue;
        if (first) {
            throw Error(ErrorCode::BadOption,
                        fmt::format("{} and {} exclude each other", first, flag));
        }
        first = flag;
    }
}

void RefuseEach(CLI::App const& verb, std::vector<char const*> const& flags,
                std::string const& why) {
    for (char const* flag : flags) {
        if (verb.count(flag)) throw Error(ErrorCode::BadOption, fmt::format("{} {}", flag, why));
    }
}

}  // namespace limn::cli
